// Camera rays, and which pixel an invocation has.
#include "shared/parameters.glsl"
#include "shared/work_groups.glsl"

struct CameraRay {
  vec3 origin;
  vec3 direction;  // unit
};

// Through `position`, in pixels from the upper left corner of the image.
CameraRay camera_ray(vec2 position) {
  vec2 size = vec2(parameters.image_size);
  vec2 ndc = vec2(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y);
  return CameraRay(parameters.camera_origin.xyz + ndc.x * parameters.film_right.xyz +
                       ndc.y * parameters.film_up.xyz,
                   normalize(parameters.camera_forward.xyz + ndc.x * parameters.camera_right.xyz +
                             ndc.y * parameters.camera_up.xyz));
}

// A point as the camera sees it.
struct CameraView {
  bool is_in_image;
  uvec2 pixel;
  vec3 direction;  // to the camera, unit
  float distance;
  float density;   // per area that faces the camera, of a pixel's rays there
};

// The inverse of camera_ray(). A pixel's rays are uniform on the film: per solid angle their density grows as 1 / cosine^3.
CameraView camera_view(vec3 position) {
  vec3 forward = parameters.camera_forward.xyz;
  bool is_flat = parameters.camera_right.xyz == vec3(0.0);
  vec3 right = is_flat ? parameters.film_right.xyz : parameters.camera_right.xyz;
  vec3 up = is_flat ? parameters.film_up.xyz : parameters.camera_up.xyz;
  vec3 way = position - parameters.camera_origin.xyz;
  float depth = dot(way, forward);
  vec2 ndc = vec2(dot(way, right) / dot(right, right), dot(way, up) / dot(up, up)) / (is_flat ? 1.0 : depth);
  vec2 size = vec2(parameters.image_size);
  vec2 place = vec2(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * size;

  CameraView view;
  view.is_in_image = depth > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, size));
  view.pixel = uvec2(clamp(place, vec2(0.0), size - 1.0));
  view.distance = is_flat ? depth : length(way);
  view.direction = is_flat ? -forward : -way / view.distance;
  float area = parameters.pixel_area;
  view.density = is_flat ? 1.0 / area : view.distance / (area * depth * depth * depth);
  return view;
}

// Work groups are 64 x 1 (shaders/README.md); each covers 8 x 8 pixels as 4 x 2
// blocks, so that neighbouring lanes trace neighbouring rays.
uvec2 pixel_of_invocation() {
  uint lane = gl_LocalInvocationID.x;
  uvec2 in_block = uvec2(lane & 3u, (lane >> 2u) & 1u);
  uvec2 block = uvec2((lane >> 3u) & 1u, lane >> 4u);
  uint group = dealt_group();
  uvec2 tile = uvec2(group % gl_NumWorkGroups.x, group / gl_NumWorkGroups.x);
  return tile * 8u + block * uvec2(4u, 2u) + in_block;
}

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

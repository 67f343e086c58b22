// What the host writes and the shaders read. This file is compiled by both: as GLSL through #include, as
// C++ by engine/gpu/structs.h. Members are vec4, uvec4 and scalars, vec3 and uvec3 with a scalar behind them, and uvec2
// at multiples of 8 bytes, so that std430, std140 and C++ agree (tests/gpu/layout_test.cpp compares every offset with
// the driver's). Integers that share a vec4 with
// floats are stored by their bits: floatBitsToUint() reads them.

// Of the bounding volume hierarchy of Goswami 2020, in preorder; the hit link of an inner node is the next node.
struct Node {
  vec4 lo;  // xyz: lower corner, w: bits of the leaf's triangles (first << LEAF_BITS | count), 0 for inner nodes
  vec4 hi;  // xyz: upper corner, w: bits of the miss link, NO_NODE at the end
};

// Of the hierarchy that is walked in order: both children. A corner is one of a grid of 65,535 steps along each axis
// over the scene (NodeGrid), in 16 bits.
struct WideNode {
  uvec4 a;  // x, y, z: first child's box: lower corner | upper corner << 16, w: second child's along x
  uvec4 b;  // x, y: second child's along y and z, z, w: links to the children (wide_nodes.glsl)
};

// A uniform block.
struct NodeGrid {
  vec4 lo;     // xyz: corner 0
  vec4 scale;  // xyz: steps per unit
};

// In the order of the leaves; what an intersection test reads. Shaders fetch it member by member, as texels.
struct TriangleShape {  // vertices, as the neighbours have them to the bit
  vec4 vertex0;
  vec4 vertex1;
  vec4 vertex2;
};

// In the same order and way; what a hit reads. In a scene that has them, further vec4 of the corner follow each of these
// (CORNER_VEC4S in scene.glsl): texture coordinates (xy: set 0, zw: set 1), its tangent, its colour.
struct TriangleShade {
  vec4 normal0;  // xyz: vertex normal, w: bits of the material
  vec4 normal1;  // w: bits of the object
  vec4 normal2;  // w: bits of the light, NO_LIGHT where it does not emit
};

// Materials, lights and their triangles are fetched member by member, too (scene.glsl).
struct Material {      // glTF metallic-roughness
  vec4 base_color;      // rgb, w: metallic
  vec4 emission;        // rgb: radiance, w: EMITS_...
  vec4 dielectric_f0;   // rgb: reflectance of the dielectric lobe at normal incidence, w: at grazing incidence
  vec4 roughness;       // x: alpha = roughness^2, 0 for a mirror, y: roughness, z: opacity, w: cutoff of the opacity, or an ALPHA_...
  vec4 specular;        // rgb: F0 of the index of refraction times its colour, where it may be above 1, w: strength
  vec4 normal_scale;    // x: of the texture of normals, y: of the coat's (z, w: unused)
  vec4 transmission;    // x: factor, y: index of refraction of the volume that it bounds, 0 for a thin wall (z, w: unused)
  vec4 absorption;      // rgb: of that volume, per length (w: unused)
  vec4 coat;            // x: clearcoat, y: its roughness (z, w: unused)
  uvec4 textures0;      // of TEXTURE_BASE_COLOR to TEXTURE_EMISSION: elements at which their TextureUse begins, or NO_TEXTURE
  uvec4 textures1;      // of TEXTURE_SPECULAR to TEXTURE_CLEARCOAT
  uvec4 textures2;      // of TEXTURE_CLEARCOAT_ROUGHNESS and TEXTURE_CLEARCOAT_NORMAL
};

// An image as a material uses it. They stand behind the materials, in the same buffer.
struct TextureUse {
  vec4 u_row;  // xyz: column of texels = dot(this, (u, v, 1)), whole numbers at centres; w: bits of the first texel
  vec4 v_row;  // xyz: row, likewise; w: bits of width - 1 | (height - 1) << TEXTURE_SIDE_BITS
  uvec4 modes;  // x, y: WRAP_... of columns and rows, z: 1 where the nearest texel is meant, w: set of coordinates
};

// An emitting triangle, in the order of the lights that they belong to. Chosen within its light in proportion
// to its power by Walker's alias method.
struct LightTriangle {
  vec4 vertex;    // xyz: first vertex
  vec4 edge1;     // w: length by which shadow rays start off the triangle
  vec4 edge2;     // w: probability of choosing it within its light / its area (per area)
  vec4 normal;    // xyz: unit, out of the front face
  vec4 radiance;  // rgb, w: 1 where the back face emits too
  uvec4 link;     // x: alias, y: light, z: alias threshold, as a part of 2^32, w: triangle in the order of the leaves
};

// A light: what next event estimation chooses among. Emitting triangles of one object that are connected; an image of
// the environment; or one of KHR_lights_punctual.
struct Light {
  vec4 choice;  // x: probability of choosing it where nothing is learned: by power, or uniform, y: by power, z: LIGHT_...
  uvec4 link;   // x: alias, y: first triangle, z: alias threshold, as a part of 2^32, w: triangles
  vec4 centre;  // xyz: mean point, or where a punctual light stands, w: area
  vec4 axis;    // xyz: mean of the unit normals by area, or where a punctual light shines to, w: mean radiance in units
                // of the brightest light, of both faces together; of a punctual light, its intensity
  vec4 intensity;  // rgb: of a punctual light, w: 1 / range
  vec4 cone;       // x: scale, y: offset of its angular attenuation (KHR_lights_punctual)
};

// A texel of the environment's image, of equal angles in latitude and longitude. They stand behind the lights, in the
// same buffer.
struct SkyTexel {
  vec4 radiance;  // rgb, w: density per solid angle of the directions that are drawn
  uvec4 link;     // x: alias, y: alias threshold, as a part of 2^32 (z, w: unused)
};

// What a state of the table stands for.
struct CellPlace {
  vec4 position;
  vec4 normal;  // unit, on the side that the cell is on
};

// Centre of a Voronoi cell, and a node of its object's tree (engine/cells/site_tree.h). Fetched as texels.
struct Site {
  vec4 position;  // w: bits of the axis by which the node is split
  vec4 normal;    // xyz: unit, w: bits of its subtree's bounds of normals: lower x, y, z, upper x, y, z
};

// The sites of an object: a range of the site buffer, in the order of the tree; and a grid of boxes over it, for each
// of which the sites are listed that can be nearest there (engine/cells/site_lists.h). Fetched as texels.
struct SiteRange {
  uvec4 range;  // x: first, y: count, z: first entry of the lists,
                // w: boxes along x, y, z, in LIST_BOX_BITS bits each; 0 where there is none
  vec4 frame;   // xyz: lower corner of the grid, w: boxes per unit
};

// Head of the list of cells that a frame has gathered targets for: the size of learn.comp's dispatch, and the list's length.
struct TouchedHead {
  uint groups_x;  // of LEARN_GROUP cells
  uint groups_y;  // 1
  uint groups_z;  // 1
  uint count;
};

// Sum of one frame's targets of a table entry, and their number: two integers in fixed point, of which every word has
// a part. The low bits of a word count, the others sum: in units of 1 or of SUM_..._UNIT. What runs over in the count
// of a word adds 1 to its sum and is counted in the next word; what runs over in its sum is added to that of the next.
//   number = number in low + 2^7 * (in middle + 2^12 * in high)
// Most targets need an addition to the low word alone.
struct TargetSum {
  uint low;
  uint middle;
  uint high;
};
const uint SUM_WORDS = 3u;
const uint SUM_LOW_COUNT_BITS = 7u;
const uint SUM_MIDDLE_COUNT_BITS = 12u;
const uint SUM_HIGH_COUNT_BITS = 10u;
const uint SUM_LOW_COUNT = (1u << SUM_LOW_COUNT_BITS) - 1u;
const uint SUM_MIDDLE_COUNT = (1u << SUM_MIDDLE_COUNT_BITS) - 1u;
const uint SUM_HIGH_COUNT = (1u << SUM_HIGH_COUNT_BITS) - 1u;
const float SUM_MIDDLE_UNIT = 33554432.0f;       // 2^(32 - 7)
const float SUM_HIGH_UNIT = 35184372088832.0f;   // 2^(32 - 7 + 32 - 12)
// A sum of so many SUM_HIGH_UNIT (2^63) counts as this.
const uint SUM_HIGH_FULL = 262144u;
// Steps of an addition: the words by their place, taking back what was added to a full sum, marking the cell.
const uint SUM_LOW = 0u;
const uint SUM_MIDDLE = 1u;
const uint SUM_HIGH = 2u;
const uint SUM_RETURN = 3u;
const uint SUM_MARK = 4u;

// What trace.comp leaves for accumulate.comp.
struct PixelSample {
  vec4 radiance;  // rgb: this frame's sample
  uvec4 counts;   // rays, path segments | connections << 16, cell lookups | fallbacks << 16, updates | saturated << 16
};

// What a frame's light paths bring to a pixel: the sums of splat.glsl, whose low words stand before the high ones.
struct PixelSplat {
  uvec2 red;
  uvec2 green;
  uvec2 blue;
  uvec2 unused;
};
const uint SPLAT_WORDS = 8u;
// Of the brightest light's radiance: 2^-36; 64 bits of it hold 2.7e8 times that radiance.
const float SPLAT_UNIT = 1.0f / 68719476736.0f;
// One splat is clamped to this many units (2^58), four million times the brightest light.
const float SPLAT_LIMIT = 288230376151711744.0f;

// An event of a light path, kept for the camera's paths of the same frame to connect to.
struct LightVertex {
  vec3 flux;   // that arrives, over the densities of all that was drawn
  float chain; // of its PathSums (event.glsl)
  vec3 wo;     // unit, to where the path came from
  float last;  // of its PathSums; where `light` is one, over the probability that the event's light samples choose it
  float second;  // what the triangle's second corner counts for at the event, and its third
  float third;
  uint triangle;
  uint light;  // NO_LIGHT where no light sample draws the way that led here
  uint events; // of the path up to this one
  float way;   // through a medium that the path does not know; 0 where it does
  uvec2 unused;
};

// Sums over all frames, each times its weight, in double precision.
struct PixelSum {
  double r;
  double g;
  double b;
  double r_squared;
  double g_squared;
  double b_squared;
};

// What went beyond a pixel's limits, over all frames; sums with the weights of their frames. Brightness is the mean over channels, before clamping.
struct PixelOutliers {
  double firefly_sum;   // brightness of all fireflies
  double clamped_away;  // brightness that clamping has removed
  float threshold;      // a sample brighter than this is a firefly
  float brightest;      // firefly
  uint brightest_frame;
  uint fireflies;
};

struct FirstHit {
  vec4 normal;
  vec4 position;
  vec4 albedo;
  vec4 emission;
};

// What the a-trous filter knows of a pixel besides its radiance.
struct FilterGuide {
  vec4 normal;
  vec4 position;  // about the centre of the visible points, in units of their spread
  vec4 divided;   // rgb: 1 where the channel was divided by the albedo, else 0
};

// Constants of one of its passes (a uniform block).
struct FilterPass {
  uvec2 image_size;  // width, height
  uint spacing;      // pixels from tap to tap
  float radiance_falloff;  // 1 / sigma^2, of this pass
  float normal_falloff;    // 1 / sigma^2
  float position_falloff;  // 1 / sigma^2
  uvec2 unused;
};

// What arrives at a point of the hemisphere about a hit, by one path (incident.comp).
struct Incident {
  vec3 radiance;
  float bin_cosine;  // mean over path_bin
  uint centre_bin;   // of the pixel's centre, NO_BIN outside the disk
  uint path_bin;     // that the path's first direction lies in, NO_BIN where there is no path
  uvec2 unused;
};

// Constants of a run (a uniform block).
struct Parameters {
  vec4 camera_origin;
  vec4 camera_right;    // scaled by tan(fov / 2) * aspect
  vec4 camera_up;       // scaled by tan(fov / 2)
  vec4 camera_forward;  // unit
  vec4 film_right;      // half the film of an orthographic camera, which has no camera_right and camera_up;
  vec4 film_up;         // zero for a perspective one
  vec3 environment;     // constant radiance
  float inverse_brightest;  // 1 / mean radiance of the brightest light or of the environment
  vec3 grid_origin;     // of cells grid: lower corner
  float grid_boxes_per_unit;
  uvec3 grid_boxes;     // along each axis
  uint cells;
  uvec2 image_size;     // width, height
  uint seed;
  uint lights;
  uint light_prior;
  uint max_bounces;
  uint russian_roulette_start;
  uint guided_bounces;
  float clamp_radiance;  // 0 where nothing is clamped
  float bsdf_fraction;
  float bin_floor;
  float light_floor;
  float cell_normal_threshold;
  float rate_constant;
  float rate_exponent;
  float initial_value;
  float shrinkage;
  float roulette_scale;
  uvec2 sky_size;       // columns, rows of the environment's image
  uint sky_first;       // element of `lights` at which it begins
  float sky_turn;       // by which its longitudes are shifted, as a part of all
  float reach;          // a length that leads out of the scene from wherever in it
  uint light_paths;     // of a frame
  vec3 scene_centre;    // of a sphere about all that stands in the scene
  float scene_radius;
  float environment_share;  // of light paths, that start at the constant environment
  float disk_pdf;           // per area, of a disk as large as that sphere
  float pixel_area;         // of the film: of a perspective one at depth 1
  uint kept_paths;          // light paths whose events are kept
  float connections;        // of an event of the camera with one of a given light path, as expected
  float unused;
  uvec2 more_unused;
};

const int BINDING_PARAMETERS = 0;
const int BINDING_NODE_GRID = 1;  // uniform
const int BINDING_Q_VALUES = 7;
const int BINDING_Q_VISITS = 8;
const int BINDING_TARGET_SUMS = 9;
const int BINDING_ACTION_STARTS = 10;
const int BINDING_NEXT_VALUES = 11;
const int BINDING_SAMPLES = 12;
const int BINDING_SUMS = 13;
const int BINDING_COUNTERS = 14;
const int BINDING_OUTPUT = 15;  // first hits, and whatever a test's shader writes
const int BINDING_TOUCHED_CELLS = 17;
const int BINDING_CELL_PLACES = 18;
const int BINDING_OUTLIERS = 19;
const int BINDING_FILTER_GUIDES = 20;
const int BINDING_FILTER_SOURCE = 21;
const int BINDING_FILTER_RESULT = 22;
const int BINDING_BSDF_SHARES = 23;
const int BINDING_SPLATS = 24;
const int BINDING_LIGHT_PATHS = 16;  // what each of them counted
const int BINDING_LIGHT_VERTICES = 6;

// Units of textures and images, for what is fetched (fetch.glsl); as storage, BINDING_FETCHED + unit. There may be more of
// them than one program may use: that is at most 16 where a device allows no more (MAX_COMPUTE_TEXTURE_IMAGE_UNITS of OpenGL
// 4.5), and of units there are 96 or more (MAX_COMBINED_TEXTURE_IMAGE_UNITS).
const int BINDING_FETCHED = 25;
const int UNIT_SHAPES = 0;
const int UNIT_SHADES = 1;
const int UNIT_NODES = 2;
const int UNIT_MATERIALS = 3;
const int UNIT_LIGHTS = 4;
const int UNIT_LIGHT_TRIANGLES = 5;
const int UNIT_SITES = 6;
const int UNIT_GRID_STATES = UNIT_SITES;  // cells are either around sites or of a grid
const int UNIT_SITE_LISTS = 7;
const int UNIT_ACTION_STARTS = 8;
const int UNIT_NEXT_VALUES = 9;
const int UNIT_Q_VALUES = 10;
const int UNIT_SAMPLES = 11;
const int UNIT_OUTLIERS = 12;
const int UNIT_SUMS = 13;
const int UNIT_BSDF_SHARES = 14;
const int UNIT_TEXELS = 15;
const int FETCHED_UNITS = 16;

const int LOCATION_FRAME = 0;    // uniform: number of the frame, from 1
const int LOCATION_TEACHES = 1;  // uniform: whether the frame gathers targets for the table
const int LOCATION_SEQUENCE = 2;  // uniform: number of the frame's sequence of Sobol' points
const int LOCATION_WEIGHT = 3;  // uniform: what the frame counts for in the sums of its pixels
const int LOCATION_POINTS = 4;  // uniforms: the frame's point of it, by block

// Blocks of four random words: one for the camera, then BLOCKS_PER_EVENT for every scattering event.
const uint BLOCK_CAMERA = 0u;
const uint BLOCK_DIRECTION = 1u;
const uint BLOCK_LIGHT = 2u;
const uint BLOCK_TWO_RAY = 3u;
const uint BLOCK_MORE = 4u;
const uint BLOCKS_PER_EVENT = 4u;
const uint BLOCKS_OF_CONNECTIONS = 0x10000000u;  // one for each event
const uint BLOCKS_OF_LIGHT_PATHS = 0x20000000u;  // the same as for the camera, of paths from the lights
const uint BLOCKS_OF_PASSING = 0x40000000u;  // one for each ray of a path, behind those of all events

// Below this a lobe is taken for a mirror's: its width, the square, comes near the rounding of directions.
const float LEAST_ROUGHNESS = 0.005f;

// Rays leave a surface by this fraction of its largest coordinate: 32 units in the last place of a float,
// above the rounding of interpolating a point and of the intersection test, which both grow with the
// coordinates.
const float OFFSET_FRACTION = 32.0f / 16777216.0f;

const uint NO_NODE = 0xffffffffu;
const uint NO_TRIANGLE = 0xffffffffu;
const uint NO_LIGHT = 0xffffffffu;
const uint NO_TEXTURE = 0xffffffffu;
const uint TEXTURE_SIDE_BITS = 16u;
const float LIGHT_SURFACE = 0.0f;  // in Light::choice.z
const float LIGHT_SKY = 1.0f;
const float LIGHT_POINT = 2.0f;
const float LIGHT_SPOT = 3.0f;
const float LIGHT_DIRECTIONAL = 4.0f;
const float ALPHA_OPAQUE = -1.0f;  // in Material::roughness.w
const float ALPHA_BLEND = -2.0f;
const float EMITS_FRONT = 0.0f;  // in Material::emission.w and LightTriangle::radiance.w
const float EMITS_BOTH = 1.0f;
const float EMITS_UNLIT = 2.0f;  // its base colour, to both sides
const int NO_CELL = -1;             // of a hit
const uint NO_BIN = 0xffffffffu;
const uint NO_ENTRY = 0xffffffffu;  // of the Q-table
const uint SHARE_BSDF = 0u;  // actions of the mixture
const uint SHARE_TABLE = 1u;
const uint LEAF_BITS = 4u;
const uint LEAF_LINK = 0x80000000u;
const uint END_OF_WALK = 0xffffffffu;
const uint BVH_DEPTH = 64u;
const uint TRACE_GROUP = 64u;  // invocations of a work group, at most, of what traverses
const uint ACCUMULATE_GROUP_PIXELS = 256u;  // of a work group of accumulate.comp
const uint LEARN_GROUP = 64u;  // invocations of a work group of learn.comp and initial_table.comp
const uint LIST_BOX_BITS = 10u;
const uint LIST_COUNT_BITS = 8u;
const uint LISTED_NORMAL = 0xffffffffu;  // in place of a site
const uint NORMAL_BOUND_BITS = 5u;  // -1 to 1, in NORMAL_BOUND_STEPS steps
const uint NORMAL_BOUND_STEPS = (1u << NORMAL_BOUND_BITS) - 1u;

// Fixed point of a target that is a radiance: 2^-20 resolves a room at 1e-3 to 0.1 % per sample; 64 bits of it
// hold 1.7e13.
const float TARGET_UNIT = 1.0f / 1048576.0f;
// Of a target that is the square of a light's contribution, in units of the brightest light: 2^-36 resolves
// contributions of 4e-6 of its radiance.
const float LIGHT_TARGET_UNIT = 1.0f / 68719476736.0f;
// One target is clamped to this many units (2^48): as one step, far below a full sum.
const float TARGET_LIMIT = 281474976710656.0f;

// Counters of a frame, of 64 bits: low and high word. The last ones stay over all frames.
const uint COUNTER_RAYS = 0u;
const uint COUNTER_SEGMENTS = 1u;
const uint COUNTER_ZERO_PATHS = 2u;
const uint COUNTER_LOOKUPS = 3u;
const uint COUNTER_FALLBACKS = 4u;
const uint COUNTER_UPDATES = 5u;
const uint COUNTER_SATURATED = 6u;
const uint COUNTER_NON_FINITE = 7u;
const uint COUNTER_FIREFLIES = 8u;
const uint COUNTER_CLAMPED = 9u;
const uint COUNTER_LIGHT_RAYS = 10u;  // of paths from the lights; they are among all rays, too
const uint COUNTER_SPLATS = 11u;
const uint COUNTER_CONNECTIONS = 12u;
const uint COUNTER_PER_FRAME = 13u;
const uint COUNTER_ALL_NON_FINITE = 13u;
const uint COUNTER_LOOPS_CUT = 14u;
const uint COUNTER_COUNT = 16u;  // even: std430 rounds the block up to 16 bytes
const uint MAX_LOCATIONS = 64u;

struct Counters {
  uvec2 cut_pixel;                 // one of those where a loop was cut
  uvec2 unused;
  uvec4 locations[MAX_LOCATIONS];  // of non-finite samples: x, y, frame
  uint words[2u * COUNTER_COUNT];  // low and high
};

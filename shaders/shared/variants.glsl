// Values of the compile-time choices. The host compiles this file, too: that they are those of its enums is asserted in
// engine/tracer/shader_variant.cpp.
#define RANDOM_INDEPENDENT 0
#define RANDOM_SOBOL 1
#define SAMPLER_BSDF 0
#define SAMPLER_UNIFORM 1
#define SAMPLER_RL 2
#define NEE_NONE 0
#define NEE_ONE_RAY 1
#define NEE_TWO_RAY 2
#define UPDATE_EXPECTED_SARSA 0
#define UPDATE_SARSA 1
#define UPDATE_Q_LEARNING 2
#define UPDATE_MONTE_CARLO 3
#define UPDATE_PAPER_LISTING 4
#define LEARNS_ALL 0
#define LEARNS_BEYOND_NEE 1
#define RATE_VISITS_PER_BIN 0
#define RATE_VISITS_PER_CELL 1
#define RATE_CONSTANT 2
#define RATE_POWER 3
#define BIN_MAP_CYLINDRICAL 0
#define BIN_MAP_CONCENTRIC 1
#define INITIAL_ZERO 0
#define INITIAL_CONSTANT 1
#define INITIAL_RANDOM 2
#define INITIAL_COSINE 3
#define BIN_WEIGHT_VALUE 0
#define BIN_WEIGHT_VALUE_COSINE 1
#define ROULETTE_THROUGHPUT 0
#define ROULETTE_REFLECTANCE 1
#define ROULETTE_VALUE 2
#define CELLS_VORONOI 0
#define CELLS_GRID 1
#define SITE_SEARCH_LISTS 0
#define SITE_SEARCH_TREE 1
#define SITE_SEARCH_LINEAR 2
#define BVH_SAH 0
#define BVH_THREADED 1
#define FETCH_TEXTURE 0
#define FETCH_IMAGE 1
#define FETCH_STORAGE 2
// Textures by what they are multiplied with (engine/scene/texture.h). TEXTURES: one bit for each that the scene has.
#define TEXTURE_BASE_COLOR 0
#define TEXTURE_METALLIC_ROUGHNESS 1
#define TEXTURE_NORMAL 2
#define TEXTURE_EMISSION 3
#define TEXTURE_SPECULAR 4
#define TEXTURE_SPECULAR_COLOR 5
#define TEXTURE_TRANSMISSION 6
#define TEXTURE_CLEARCOAT 7
#define TEXTURE_CLEARCOAT_ROUGHNESS 8
#define TEXTURE_CLEARCOAT_NORMAL 9
#ifndef TEXTURES
#define TEXTURES 0
#endif
#define HAS_TEXTURE(slot) (((TEXTURES) >> (slot)) & 1)
#define WRAP_REPEAT 0
#define WRAP_MIRRORED_REPEAT 1
#define WRAP_CLAMP_TO_EDGE 2

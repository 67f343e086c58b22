// Buffers that a shader only reads, fetched element by element in the way that suits the driver (engine/gpu/fetch.h).
//   FETCHED_VEC4(name, unit); ... vec4 x = fetch(name, i);      the same for FETCHED_UVEC4
//   FETCHED_UINT(name, unit); ... uint x = fetch_one(name, i);  the same for FETCHED_FLOAT
//   FETCHED_HALF4(name, unit); ... vec4 x = fetch_half4(name, i);  four numbers in 16 bits each
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#if FETCH == FETCH_IMAGE

#define FETCHED_VEC4(name, unit) layout(rgba32f, binding = unit) uniform restrict readonly imageBuffer name
#define FETCHED_UVEC4(name, unit) layout(rgba32ui, binding = unit) uniform restrict readonly uimageBuffer name
#define FETCHED_FLOAT(name, unit) layout(r32f, binding = unit) uniform restrict readonly imageBuffer name
#define FETCHED_UINT(name, unit) layout(r32ui, binding = unit) uniform restrict readonly uimageBuffer name
#define FETCHED_HALF4(name, unit) layout(rgba16f, binding = unit) uniform restrict readonly imageBuffer name
#define fetch(name, i) imageLoad(name, int(i))
#define fetch_half4(name, i) fetch(name, i)
#define fetch_one(name, i) imageLoad(name, int(i)).x

#elif FETCH == FETCH_TEXTURE

#define FETCHED_VEC4(name, unit) layout(binding = unit) uniform samplerBuffer name
#define FETCHED_UVEC4(name, unit) layout(binding = unit) uniform usamplerBuffer name
#define FETCHED_FLOAT(name, unit) layout(binding = unit) uniform samplerBuffer name
#define FETCHED_UINT(name, unit) layout(binding = unit) uniform usamplerBuffer name
#define FETCHED_HALF4(name, unit) layout(binding = unit) uniform samplerBuffer name
#define fetch(name, i) texelFetch(name, int(i))
#define fetch_half4(name, i) fetch(name, i)
#define fetch_one(name, i) texelFetch(name, int(i)).x

#else

#define FETCHED_BUFFER(type, name, unit) \
  layout(std430, binding = BINDING_FETCHED + unit) restrict readonly buffer name##_block { type name[]; }
#define FETCHED_VEC4(name, unit) FETCHED_BUFFER(vec4, name, unit)
#define FETCHED_UVEC4(name, unit) FETCHED_BUFFER(uvec4, name, unit)
#define FETCHED_FLOAT(name, unit) FETCHED_BUFFER(float, name, unit)
#define FETCHED_UINT(name, unit) FETCHED_BUFFER(uint, name, unit)
#define FETCHED_HALF4(name, unit) FETCHED_BUFFER(uvec2, name, unit)
#define fetch(name, i) name[i]
#define fetch_half4(name, i) vec4(unpackHalf2x16(name[i].x), unpackHalf2x16(name[i].y))
#define fetch_one(name, i) name[i]

#endif

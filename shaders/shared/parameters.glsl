// What stays the same throughout a dispatch: the run's constants, and the frame.
#include "shared/structs.glsl"

layout(std140, binding = BINDING_PARAMETERS) uniform ParameterBlock { Parameters parameters; };
layout(location = LOCATION_FRAME) uniform uint frame_number;
layout(location = LOCATION_TEACHES) uniform uint frame_teaches;
#ifdef STRATIFIED_EVENTS
layout(location = LOCATION_SEQUENCE) uniform uint frame_sequence;
layout(location = LOCATION_POINTS) uniform uvec4 sobol_points[STRATIFIED_EVENTS * int(BLOCKS_PER_EVENT) + 1];
#endif

// What stays the same throughout a dispatch: the run's constants, and the frame.
#include "shared/structs.glsl"

layout(std140, binding = BINDING_PARAMETERS) uniform ParameterBlock { Parameters parameters; };
layout(location = LOCATION_FRAME) uniform uint frame_number;
layout(location = LOCATION_TEACHES) uniform uint frame_teaches;

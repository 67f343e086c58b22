// Values of the compile-time choices, in the order of the enums of engine/core/settings.h.
#define SAMPLER_BSDF 0
#define SAMPLER_UNIFORM 1
#define SAMPLER_RL 2
#define NEE_NONE 0
#define NEE_ONE_RAY 1
#define NEE_TWO_RAY 2
#define UPDATE_EXPECTED_SARSA 0
#define UPDATE_Q_LEARNING 1

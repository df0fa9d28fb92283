// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "rolling_model_epsd2.h"
#include "rolling_model_vielto.h"

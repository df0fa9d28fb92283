// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "normal_model_cohfrict.h"
#include "normal_model_vielto.h"

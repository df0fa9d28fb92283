// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "surface_model_default.h"

// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "tangential_model_history.h"
#include "tangential_model_vielto.h"

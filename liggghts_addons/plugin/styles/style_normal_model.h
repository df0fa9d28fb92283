// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "normal_model_cohfrict.h"
#include "normal_model_hertz.h"
#include "normal_model_hooke.h"
#include "normal_model_stock.h"
#include "normal_model_vielto.h"

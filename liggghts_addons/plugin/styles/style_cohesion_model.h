// Models of this kind that we instantiate; LIGGGHTS' own build makes this list, its package does not hold it.
#include "cohesion_model_adhesion.h"
#include "cohesion_model_easo_capillary_viscous.h"
#include "cohesion_model_sjkr.h"
#include "cohesion_model_sjkr2.h"
#include "cohesion_model_washino_capillary_viscous.h"

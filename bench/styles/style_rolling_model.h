// ViElTo and its stock peer.
#include "rolling_model_epsd2.h"
#include "rolling_model_vielto.h"

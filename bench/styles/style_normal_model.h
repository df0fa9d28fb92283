// ViElTo and its stock peer.
#include "normal_model_hooke_stiffness.h"
#include "normal_model_vielto.h"

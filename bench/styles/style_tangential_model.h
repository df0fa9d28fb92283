// ViElTo and its stock peer.
#include "tangential_model_history.h"
#include "tangential_model_vielto.h"

#include "control/gait_overrides.h"

#include "control/control.h"

namespace gaitpad {}

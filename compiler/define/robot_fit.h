// Whether a robot's drives fit its description: what else would fail only when an episode begins.
#pragma once

#include "compiler/model/model.h"
#include "compiler/names/context.h"

namespace probe::sema {

// P1004: a joint that moves without a drive, a driven one that moves neither tool nor finger,
// drives in another order than that of actions and states, a tool that points along the fingers'
// way, and whatever else the law's own controller refuses. Of a robot without other mistakes.
void check_fit(Context& context, const Robot& robot);

}  // namespace probe::sema

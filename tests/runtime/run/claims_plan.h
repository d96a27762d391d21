// A plan of two tasks in the same words: a lying spoon stays left of the cube, one that is put down
// on its end falls over.
#pragma once

#include "tests/runtime/run/plan_of_text.h"

namespace probe::run {

inline const char* const kClaimsText = R"(use "suite/intact.probe"
relation on_left(a: object, b: object, by: length = 2cm) "left" = y(a) > y(b) + by

object lying like spoon { phrase side spatial "spoon left of the green cube" means on_left green_cube }
object standing like lying { rest pitch 80deg yaw 90deg }

layout row {
  place source at (-22cm, 8cm); place target at (-12cm, -8cm); place distractors at (-11cm, 4.5cm)
  orient by rest; drop 1cm settle 0.5s
}
task stays like on_table {
  source lying; target towel; distractors green_cube; layout row; say put_the; metrics put_loose
  horizon 6 steps; refer source as side
}
task falls like stays { source standing; refer source as side }
suite mine trained on bridge_v2 { tasks { stays, falls }; seeds 42 }
)";

inline const plan::Plan& claims_plan() {
  static const plan::Plan plan = plan_of_text(kClaimsText);
  return plan;
}

}  // namespace probe::run

// The fixtures with joints of a task and the regions of its scene, for `show`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// [{fixture, joints: [{joint, moves, lower, upper, start, friction, damping, stiffness, rest}],
// parts:
// [{part, name, joint}]}] of the task's scene; m and N, or rad and N m. `start` is where the joint
// begins in this task's first start, and `starts` {least, most, each[]}, where starts differ in it.
// Only parts that the text names. Where links are seen at times, `shown` [{link, joint, when, at}].
Json fixtures_of(const plan::Plan& plan, std::uint32_t task);
// [{region, of, low, high}]: m, in the frame of what they belong to. Of all bodies of the task.
Json regions_of(const plan::Plan& plan, std::uint32_t task);
Json names_of(const Json& regions);

// ["cabinet.top 4 cm", "cabinet.bottom 0 cm"]: where joints begin, of fixtures_of().
Json joint_starts_text(const Json& fixtures);

// Of joints in which starts differ: "cabinet.top" and "4cm", a text a start.
struct BegunColumn {
  std::string joint;
  std::vector<std::string> starts;
};
std::vector<BegunColumn> begun_columns(const Json& fixtures);

// "cabinet: top slides 0 .. 18 cm, starts at 0; parts top_drawer", a text a fixture.
std::vector<std::string> fixture_lines(const Json& task);

}  // namespace probe::inspect

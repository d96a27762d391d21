// What begins and stands otherwise than it looks: objects that fall onto one another, parts of
// fixtures that are drawn and cannot be touched.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"

namespace probe::audit {

// Starts of a task in which the upright boxes around two objects overlap as seen from above by more
// than a centimetre, and one is so far above the other that it falls. What begins on something, as a
// layout puts it there, is left out.
struct Falls {
  std::size_t starts = 0, of = 0;
  std::size_t first = 0;   // the first such start
  std::string first_pair;  // "`pepsi` and `sponge`"
};
Falls falls_in(const plan::Plan& plan, std::uint32_t task);

// One sentence for each link of a fixture whose drawn boxes reach more than 5 mm beyond what is felt
// of it. Links with meshes are left out: their extents are not at hand here.
std::vector<std::string> unfelt_in(const Compilation& compilation, const plan::Plan& plan,
                                   std::uint32_t fixture);

}  // namespace probe::audit

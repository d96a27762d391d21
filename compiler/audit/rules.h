// A task's rules put to the test: the judge is run on worlds made up for the purpose, so that what
// is found does not depend on how a rule is written.
#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::audit {

// Whether metric `wrong` is true when the target alone was moved, by 10 cm, and not before.
Result<bool> wrong_counts_target(const plan::Plan& plan, std::uint32_t task, std::uint32_t wrong);

// Whether metric `success` is true of a source that lies on the surface beside the target, so that
// their boxes do not overlap, where one that lies on the target or in it passes as well. Never of a scene with a fixture, where the surface is not what things
// lie on.
Result<bool> passes_beside(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// The same of a source that nothing but the scene's fixture holds up, at a height up to 10 cm above
// the target's lower side. Never of a scene without a fixture.
Result<bool> passes_on_fixture(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// Whether metric `success` is true of a source that was brought over the target and is still held
// there: both fingers press it, half a millimetre above the target or in the middle of a region of
// the target's own, and nothing else touches it.
Result<bool> passes_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);
// The same of a world in which nothing has moved and objects lie far apart, of a task that measures
// joints of fixtures: a drawer that is to be opened begins open in some start.
Result<bool> holds_at_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// The same two questions of tasks that put several things somewhere, asked of each of these while
// the others are where they belong, put there in their order.
struct SeveralPut {
  bool is_one = true;       // one thing is put, or none: the questions above are all
  bool is_known = false;    // where things belong was found out, so each was asked about
  bool beside = false, held = false;  // true of one that lies on the surface; that is still held
};
Result<SeveralPut> passes_of_several(const plan::Plan& plan, std::uint32_t task,
                                     std::uint32_t success);

// Of a task with a source and no target: whether metric `success` is true of one that is 30 cm above
// where it lay and touches nothing, and is not so where it lies.
Result<bool> passes_in_the_air(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// Whether a metric that is read at the end depends on whether two bodies have ever touched.
bool counts_an_earlier_touch(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// Whether metric `success` is false unless fingers touch for some steps on end, the last one
// included: a condition held over steps that nothing latches.
bool ends_in_grasp(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

}  // namespace probe::audit

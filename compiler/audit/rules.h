// A task's rules put to the test: the judge is run on worlds made up for the purpose, so that what
// is found does not depend on how a rule is written.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "compiler/audit/fixture_starts.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::audit {

// Where a rule is broken: the first start of a kind in which it is. Each kind is asked about, as
// joints begin there and objects are turned; none: in no start.
using BrokenIn = std::optional<std::uint32_t>;

// Metric `wrong` is true when the target alone was moved, by 10 cm, and not before.
Result<BrokenIn> wrong_counts_target(const plan::Plan& plan, std::uint32_t task,
                                     std::uint32_t wrong);

// Metric `success` is true of a source that lies on the surface beside the target, so that
// their boxes do not overlap, where one that lies on the target or in it passes as well. Never of a
// scene with a fixture, where the surface is not what things lie on.
Result<BrokenIn> passes_beside(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// The same of a source that nothing but the scene's fixture holds up, at a height up to 10 cm above
// the target's lower side. Never of a scene without a fixture.
Result<BrokenIn> passes_on_fixture(const plan::Plan& plan, std::uint32_t task,
                                   std::uint32_t success);

// Metric `success` is true of a source that was brought over the target and is still held
// there: both fingers press it, half a millimetre above the target or in the middle of a region of
// the target's own, and nothing else touches it.
Result<BrokenIn> passes_held(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// Whether metric `success` is true where nothing has moved: of a world in which objects lie far
// apart, of a task that measures joints of fixtures (a drawer that is to be opened begins open in
// some start); or of what a layout puts on another thing or into a region.
Result<bool> holds_at_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t success,
                            FixtureStarts& fixtures);

// The same two questions of tasks that put several things somewhere, asked of each of these while
// the others are where they belong, put there in their order.
struct SeveralPut {
  // In each kind of start one thing is put, or none, so that the questions above are all; or where
  // things belong was found out, so each was asked about.
  bool is_tried = true;
  BrokenIn beside, held;  // by one that lies on the surface; that is still held
};
Result<SeveralPut> passes_of_several(const plan::Plan& plan, std::uint32_t task,
                                     std::uint32_t success);

// Of a task with a source and no target: metric `success` is true of one that is 30 cm above
// where it lay and touches nothing, and is not so where it lies.
Result<BrokenIn> passes_in_the_air(const plan::Plan& plan, std::uint32_t task,
                                   std::uint32_t success);

// Whether a metric that is read at the end depends on whether two bodies have ever touched.
bool counts_an_earlier_touch(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

// Whether metric `success` is false unless fingers touch for some steps on end, the last one
// included: a condition held over steps that nothing latches.
bool ends_in_grasp(const plan::Plan& plan, std::uint32_t task, std::uint32_t success);

}  // namespace probe::audit

// What `list` and `show` say of a task, as JSON with the documented keys and as text for people.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// Indices of all tasks, or of the members of a suite of the plan.
std::vector<std::uint32_t> all_tasks(const plan::Plan& plan);
std::vector<std::uint32_t> members(const plan::Plan& plan, std::uint32_t suite);

// {tasks, episodes}: all that they have, or what a suite runs of them.
Json count(const plan::Plan& plan, std::span<const std::uint32_t> tasks,
           const plan::SuiteRecord* suite = nullptr);
// An array of {task, baseline, axes[], categories[], prompt, episodes}.
Json list(const plan::Plan& plan, std::span<const std::uint32_t> tasks,
          const plan::SuiteRecord* suite = nullptr);
// One task: the same and {source, target (null: none), roles {}, distractors[], placed[], horizon,
// metrics[], starts[][], scene, robot {}, camera, cameras[]{name, camera}, light, ood[], drop_m,
// settle_s, allow, distances_m[], ids{prompt, judge, starts[], episodes[]}, questions[],
// not_asked[]}. `robot` is robot_json.h's. `camera` is the first of `cameras`, whose `name` is what
// policies know it by. A distance is from source to target, horizontal, in the order of the starts.
// Where suites run some of the starts, `drawn`[]{suite, starts[]} has their numbers; where cameras
// jitter, `shaken`[][]{camera, moved_m[3], turned_wxyz[4]} has how, a list a start, in the frame of
// the mount and about ahead, left, up. `questions` and `not_asked` are those of question_json.h.
Json describe(const plan::Plan& plan, std::uint32_t task);

// A line a task: name, episodes, instruction; at most 100 columns.
std::string list_text(const Json& list);
// Lengths in cm, ids shortened to eight digits.
std::string describe_text(const Json& task);

}  // namespace probe::inspect

// What success lacks of one word of the table of goal_words.def, construct by construct; nothing
// where it is there or nothing is certain.
#pragma once

#include <optional>
#include <string>

#include "compiler/check/goal_words.h"
#include "compiler/check/told.h"

namespace probe::sema {

// "close the drawer" of which success is that it is open.
std::optional<std::string> joint_word_lack(Told& told, const GoalWords& one);
// "between A and B" of which success is that it lies on A.
std::optional<std::string> among_word_lack(Told& told, const GoalWords& one);
// "to the left of the plate" of which success is that it lies on the plate.
std::optional<std::string> side_word_lack(Told& told, const GoalWords& one);
// "first A, then B" of which success is that B was done first, wants no order of the two, or is
// content with A.
std::optional<std::string> order_word_lack(Told& told, const GoalWords& one);
// "both spoons" of which success is that any of them is there.
std::optional<std::string> each_word_lack(Told& told, const GoalWords& one);
// "without touching the can" of which success measures nothing of the can.
std::optional<std::string> spare_word_lack(Told& told, const GoalWords& one);
// "do not move the can" of which no metric at all measures anything.
std::optional<std::string> leave_word_lack(Told& told, const GoalWords& one);

}  // namespace probe::sema

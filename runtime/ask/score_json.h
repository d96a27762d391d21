// Counts of answers as JSON.
#pragma once

#include "runtime/ask/score.h"
#include "runtime/base/json.h"

namespace probe::ask {

// A list with an object for each arm: {"question": "SET.FAMILY", "arm", "right_in_every_order":
// RATE, "right_in_one_order": RATE, the same of "likeliest_in_every_order" and
// "likeliest_in_one_order" where the server gave log-probabilities, else null;
// "luck_in_every_order", "luck_in_one_order": of any answer, each as likely, 0 .. 1 or null;
// "rows", and of these "unclear", "cut", "refused", "empty", "invalid"; "incomplete": questions and
// starts without a verdict}. RATE: {"right", "asked", "low", "high"}: 95 %, null where nothing was
// asked.
Json arms_json(const plan::Plan& plan, const ScoreRow& row);

}  // namespace probe::ask

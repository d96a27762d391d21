// Whether a model of the caller's is the one that a folder was begun with. Of a function nothing is
// known but its name, which another one may have: before it continues a folder it answers a stored
// question again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/ask/answers.h"
#include "runtime/ask/ask.h"
#include "runtime/ask/prepared.h"
#include "runtime/stage/assets.h"

namespace probe::ask {

// In: options whose `out` is the folder that `answers` writes and whose `own_model` is asked, what
// is asked of which looks. The first valid answer that is stored of them is asked for again, and
// the words are held against the stored ones, byte for byte; nothing is stored. Fails (kStore)
// naming the question that was answered otherwise; with IfChanged::kContinue that is a note.
// Without a valid answer nothing is said.
Status check_callers_model(const plan::Plan& plan, const AskOptions& options,
                           const Queries& queries, const RecordedRows& recorded,
                           std::shared_ptr<const stage::SharedAssets> assets, Answers& answers,
                           std::vector<std::string>& notes);

}  // namespace probe::ask

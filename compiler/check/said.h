// Where an instruction speaks of what: by slots, and by names among the words that are written out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

struct Said {
  struct Word {
    std::string text;   // folded, without the signs around it; empty of a slot
    Things of;          // what a slot means, or a name that begins here
    bool ends = false;  // a sign follows
  };
  std::vector<Word> words;

  // Where a thing is spoken of first.
  std::optional<std::size_t> first(ObjectId thing) const;
  // Where these written words begin, from some word on.
  std::optional<std::size_t> find(std::string_view written, std::size_t from = 0) const;
};

// In: a complete task. A name is that of an object or a declared part of the task's scene, or the
// last word of one that no other there ends with.
Said said_by(const Model& model, const Task& task);

// The objects of a task and the declared parts of its scene's fixtures.
std::vector<ObjectId> nameable(const Model& model, const Task& task);

// In lower case, at blanks, without the signs around words.
std::vector<Said::Word> words_in(std::string_view text);

// Whether what stands before this folded word may be a noun: "on", "and", not "opener".
bool may_follow_noun(std::string_view word);

// The same words alone.
std::vector<std::string> folded_words(std::string_view text);

}  // namespace probe::sema

// The words of an instruction, each by what it may be in a clause: the closed classes of
// clause_words.def, read at a place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

enum class WordIs : std::uint8_t {
  kUnknown,
  kPuts,
  kTakes,
  kOpens,
  kCloses,
  kDoes,
  kTo,
  kBeside,
  kFrom,
  kAt,
  kWith,
  kJoins,
  kAnd,
  kOr,
  kIt,
  kThe,
  kEach,
  kSome,
  kNone,
  kBut,
  kIs,
  kWhere,
  kBegins,
  kTurn,
  kRepeats,
  kPlace,
  kShut,
  kIdle,
  kSpares,
  kDenies
};
class ClauseWords {
 public:
  ClauseWords(const Model& model, const Task& task);

 protected:
  struct Token {
    std::string text;  // folded; of a slot empty
    Things of;         // what a slot means
    bool is_slot = false, is_set = false;
    bool ends = false;  // a sign follows
    std::string shown;  // as it is quoted
  };

  struct Match {
    WordIs is = WordIs::kUnknown;
    std::size_t length = 0;
  };

  Match match(std::size_t at) const;
  static bool is_verb(WordIs is) { return is >= WordIs::kPuts && is <= WordIs::kDoes; }
  static bool is_place(WordIs is) { return is >= WordIs::kTo && is <= WordIs::kWith; }
  static bool joins(WordIs is);
  bool ends_at(std::size_t at) const { return at > 0 && words_[at - 1].ends; }
  std::vector<std::string> texts(std::size_t at, std::size_t most) const;
  std::string shown(std::size_t from, std::size_t to) const;

  const std::vector<Token> words_;

 private:
  static std::vector<Token> tokens_of(const Model& model, const Task& task);
};

}  // namespace probe::sema

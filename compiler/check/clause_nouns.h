// Nouns of an instruction with what stands before them: "the red cube", "both cups and the can".
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/check/called.h"
#include "compiler/check/clause_words.h"
#include "compiler/check/clauses.h"
#include "compiler/model/model.h"

namespace probe::sema {

class ClauseNouns : public ClauseWords {
 public:
  ClauseNouns(const Model& model, const Task& task, Callings& callings)
      : ClauseWords(model, task), called_(model, task, callings) {}

 protected:
  // A noun with what stands before it.
  struct Noun {
    std::vector<Clause::What> what;
    std::size_t end = 0;
    bool is_place = false;  // no thing
  };

  // What stands before a noun, and where that begins.
  std::size_t before_noun(std::size_t at, Clause::What& how) const;
  // Nothing where the words at `at` are no noun that is known.
  std::optional<Noun> noun(std::size_t at);
  // "The top drawer of the cabinet".
  void of_what(Noun& found);
  // "The green and the yellow cube".
  std::optional<Noun> shared_noun(std::size_t at);
  // Nouns with "and" between them, and signs before the last of them.
  std::optional<Noun> nouns(std::size_t at, bool is_where);
  static void take_either(Noun& nouns);
  // "The cube or the can".
  void or_another(Noun& found);
  // Whether nouns stand here, and a place behind them.
  bool begins_again(std::size_t at);

  const Called called_;
  Clauses out_;  // as far as it was read: what was spoken of, whether words are pure
};

}  // namespace probe::sema

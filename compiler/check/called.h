// What may be called how in a task: nouns of objects, parts and fixtures by their names, the words
// of their phrases and the values of their attributes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

class Called {
 public:
  Called(const Model& model, const Task& task);

  // All that the longest beginning of these folded words may mean: by a name or the words of a
  // phrase, else by the noun at the end of one with words before it that are true of the thing. A
  // noun may be in the plural. Length 0: nothing is called so.
  struct Found {
    Things of;
    std::size_t length = 0;
    bool is_plural = false;
  };
  Found find(const std::vector<std::string>& words) const;

  // Whether a word stands before the noun of some name, or is a value of an attribute.
  bool is_adjective(std::string_view word) const;

  // Whether a thing is of one of the same fixtures as these.
  bool has_part(const Things& of, ObjectId thing) const;

 private:
  struct Thing {
    ObjectId id = ObjectId::kNone;
    std::vector<std::vector<std::string>> names;  // its own, of its phrases, of its fixture
    std::vector<std::string> nouns;               // of them: "bowl" of "bowl on the left"
    std::vector<std::string> adjectives;          // words before them, values of attributes
  };
  static bool is_name(const Thing& thing, const std::vector<std::string>& words,
                      std::size_t length);
  static bool is_noun(const Thing& thing, const std::vector<std::string>& words,
                      std::size_t length);

  const Model& model_;
  std::vector<Thing> things_;
};

}  // namespace probe::sema

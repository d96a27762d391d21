// What may be called how in a task: nouns of objects, parts and fixtures by their names, the words
// of their phrases and the values of their attributes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

// What one thing may be called, whichever task it is in.
struct Calling {
  ObjectId id = ObjectId::kNone;
  std::vector<std::vector<std::string>> names;  // its own, of its phrases, of its fixture
  std::vector<std::string> nouns;               // of them: "bowl" of "bowl on the left"
  std::vector<std::string> adjectives;          // words before them, values of attributes
};

// Of all things of a model, each read when first asked for.
class Callings {
 public:
  explicit Callings(const Model& model) : model_(model) {}
  const Calling& of(ObjectId thing);

 private:
  const Model& model_;
  std::map<ObjectId, Calling> known_;
};

class Called {
 public:
  Called(const Model& model, const Task& task, Callings& callings);

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

  // Where the first of these words is a value of some attribute and true of none of the things that
  // the others mean, as far as is known, and nothing that was declared is called so: the attribute,
  // and what it is of the first of them.
  std::optional<std::pair<std::string, std::string>> other_than(
      const std::vector<std::string>& words, const Things& of) const;

  bool is_of_fixture(ObjectId thing) const { return model_.objects[thing].of.has_value(); }

  // Those that a word before their noun is true of.
  Things with(std::string_view adjective, const Things& of) const;

  // Whether a thing is of one of the same fixtures as these.
  bool has_part(const Things& of, ObjectId thing) const;

 private:
  static bool is_name(const Calling& thing, const std::vector<std::string>& words,
                      std::size_t length);
  static bool is_noun(const Calling& thing, const std::vector<std::string>& words,
                      std::size_t length);

  const Model& model_;
  std::vector<const Calling*> things_;
};

}  // namespace probe::sema

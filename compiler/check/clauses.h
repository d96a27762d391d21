// What an instruction tells to do, clause by clause: a verb, what is handled, where it goes.
// English as far as it is certain; a clause with a word that is in no table and names nothing says
// nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/check/goal.h"
#include "compiler/model/model.h"

namespace probe::sema {

class Callings;

struct Clause {
  enum class Does : std::uint8_t { kPuts, kTakes, kOpens, kCloses, kOther } does = Does::kOther;
  // One after the other what it is done with, by all that the words may mean: several things of
  // "it", of a noun of several, of a noun in the plural.
  struct What {
    Things of;
    std::size_t count = 0;    // "both cubes", "three cubes"; 0 where nothing counts
    bool is_back = false;     // "it": something that was spoken of
    bool is_several = false;  // a noun in the plural
    bool is_each = false;     // "all drawers", "every drawer", "everything"
    bool is_some = false;     // "one of the drawers", "a drawer", "A or B": it is not said which
  };
  std::vector<What> what;
  Things where;  // where it goes, by all that the words may mean
  // What is said of those places: it lies on or over them, under them, or at their sides; several
  // of one clause are mixed. "On the left of" a thing is beside it or on it.
  enum class Where : std::uint8_t {
    kElsewhere,
    kOn,
    kUnder,
    kBeside,
    kOnOrBeside,
    kMixed
  } lies = Where::kElsewhere;
  bool is_aside() const { return lies == Where::kBeside || lies == Where::kOnOrBeside; }
  bool goes = false;          // it is said where to, in words that are known
  bool is_anywhere = false;   // "in a drawer", "on either of the plates"
  Things from;                // "take the cup off the plate"
  bool begins_there = false;  // and so it began there: not "away from the plate"
  Things spared;              // "the cup but not the can"
  bool is_kept = false;       // "keep the drawer closed"
  std::string ground;         // "on the table": the word, of what is no thing
  std::string repeats;        // "twice"
  bool certain = true;        // all of its words were understood
  std::string stopped;        // where not: the word that was not
  bool denied = false;  // "do not put ..": the first of an instruction, and alone; "neither .. nor"
  bool is_none = false;  // "put neither .. nor ..": its own words deny it
  std::string words;     // "put the red block on the tray"
};

// "the red block first", "the red block last", beside clauses or of one.
struct Rank {
  Things of;
  bool is_last = false;
  std::string words;
};

struct Clauses {
  std::vector<Clause> all;
  std::vector<Rank> ranks;
  // A thing by a word that is true of others: "the blue cube" of one that is red.
  struct Mistaken {
    ObjectId thing = ObjectId::kNone;
    std::string words, attribute, value;  // "blue cube", "color", "red"
  };
  std::vector<Mistaken> mistaken;
  // Words outside of clauses, and of what they speak. `is_spared`: nothing is to be done to it.
  struct Left {
    std::string words;
    Things of;
    bool is_spared = false;
  };
  std::vector<Left> left;
  bool is_whole = true;  // no word of the instruction is outside of them
  Things said;           // all that is spoken of
  // Its words but for slots are those of the tables: it means the same of whatever fills the roles.
  bool is_pure = true;
};

// In: a complete task.
Clauses clauses_of(const Model& model, const Task& task, Callings& callings);

}  // namespace probe::sema

// What success asks of one task: of which objects, which way, in which order. As far as it is
// certain; where a goal leaves something open, nothing is said of it here.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/model/model.h"

namespace probe::sema {

using Things = std::set<ObjectId>;  // objects, parts and regions of fixtures

struct Goal {
  // A predicate that has to hold, with what each of its parameters is of.
  struct Asked {
    PredicateId predicate = PredicateId::kNone;
    std::vector<Things> of;
    bool operator<(const Asked& other) const {
      return std::pair(predicate, of) < std::pair(other.predicate, other.of);
    }
  };
  std::set<Asked> asked;
  // Two things that one comparison measures, the lower id first.
  std::set<std::pair<ObjectId, ObjectId>> compared;
  // What is done with the first is so at a step at which what is done with the second is not yet.
  std::set<std::pair<Things, Things>> order;
  // Things of which it is enough that one is so.
  std::set<Things> one_of;
  // Two things of which one may do as well as the other: the same is asked of either (`or`).
  std::set<Things> either;
  // Something is measured that is one way on the left and another on the right: a coordinate, a
  // region, a direction, a joint. What is the same on either side is none: a square, `abs`.
  bool tells_sides = false;
  // How it measures two things against one another, the lower id first: so that they are near when
  // it holds, so that they are apart, or otherwise. Denied conditions alone: not `asked`.
  struct Bearing {
    bool near = false, apart = false, other = false, asked = false;
    void add(const Bearing& one) {
      near = near || one.near;
      apart = apart || one.apart;
      other = other || one.other;
      asked = asked || one.asked;
    }
  };
  std::map<std::pair<ObjectId, ObjectId>, Bearing> bearings;
  // What metrics beside success measure of one another.
  std::set<std::pair<ObjectId, ObjectId>> measured_beside;
  // Which way it wants the joint that moves a part: at least so far from where it is closed, at
  // most so far, or otherwise. Of a joint that moves no declared part: `moves_unnamed`.
  struct Way {
    bool opens = false, closes = false, other = false;
  };
  std::map<ObjectId, Way> ways;
  bool moves_unnamed = false;
  // Of what it speaks by name or role, of whatever condition; of everything, where it goes through
  // a set that names nothing.
  Things spoken;
  bool speaks_of_all = false;
  // Something that has to hold of things that are not named: what is said of one may be meant.
  bool asks_of_all = false;
  // It holds of what is at the last step alone, and nothing in it remembers an earlier one.
  bool forgets = false;
  // Of two things that the first is higher, whatever their sizes.
  std::set<std::pair<ObjectId, ObjectId>> above;
  // What has to be higher than it began, and what elsewhere than it began, for certain.
  Things raised, shifted;
  // Which way a thing has to have gone, as the first camera sees it.
  enum class Went : std::uint8_t { kLeft, kRight, kNearer, kFarther };
  std::set<std::pair<ObjectId, Went>> went;
};

// In: a complete task. Bounded by the text: a predicate is looked at once for what it is given.
Goal goal_of(const Model& model, const Task& task);

// What is said of a goal that is content with one of several: "succeeds with one of 3 (`any`, not
// `all`)".
std::string content_with_any(const Things& of);
std::string content_with_either(const Things& of);

// Whether some metric of the task may measure something of a thing: by name, by role, or through a
// set that it may be in.
bool is_measured(const Model& model, const Task& task, ObjectId thing);

}  // namespace probe::sema

// Whether relations hold in a start of a task, and what phrases that use them denote there. Nothing
// has moved yet, but settling moves things a little: what that may turn over is unknown.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compiler/define/denote.h"
#include "compiler/geometry/centre.h"
#include "compiler/lower/lower.h"
#include "runtime/base/asset_root.h"

namespace probe::sema {

// Objects come to rest at most so far from where they are put down, along each axis (m): on the
// flat surface, and where a fixture may turn them aside. Over the suites that are shipped 0.01 mm
// and 2.8 mm (the basket in the sink) were measured.
inline constexpr double kSettlesOnSurface = 0.002, kSettlesOnFixture = 0.005;

// What words may denote in a task, objects and parts of fixtures, each with the body that it is.
struct Scenery {
  std::vector<ObjectId> things;
  std::vector<std::uint16_t> bodies;  // by thing
  std::size_t body_count = 0;         // of the task, where there are parts; else its objects
};
Scenery scenery_of(const Model& model, const Task& task);

// The objects of a task where a start puts them down, as far as that is known before they settle.
std::vector<lower::PlacedBody> placed_objects(const Model& model, Centres& centres,
                                              const Task& task, const Start& start);

// Of those, by their bodies: what the rest of a phrase fits, when nothing is said of where they
// are.
struct Alike {
  std::vector<std::uint16_t> sure, all;  // for certain, and with those that may be
};
Alike alike_of(const Model& model, const Scenery& scenery, const Phrase& phrase);
// Things of the task that do not say an attribute for which the phrase asks, in words: where they
// are decides nothing of them. Empty where all say it.
std::string unsaid_in(const Model& model, const Task& task, const Phrase& phrase);

// The bodies of a relation of a phrase, `described` first; nothing where it holds of none: to an
// object that is not there, to itself, or among those alike of which it is the only one.
std::optional<std::vector<std::uint16_t>> related_bodies(const Model& model, const Scenery& scenery,
                                                         const QueryOp& op, std::uint16_t described,
                                                         const Alike& alike);

// Relations as programs, made once for all tasks that see them from one camera in one scene.
class Relations {
 public:
  // What cannot be measured is reported once, and unknown from then on.
  Relations(const Model& model, AssetRoot asset_root, Diagnostics& diagnostics)
      : model_(model), centres_(std::move(asset_root)), diagnostics_(diagnostics) {}

 private:
  friend class InStart;
  using Key = std::pair<std::pair<SceneId, CameraId>, std::vector<std::uint32_t>>;

  const lower::Program* program(const Task& task, std::uint32_t relation,
                                const std::vector<std::uint16_t>& of,
                                const std::vector<std::uint16_t>& alike);

  const Model& model_;
  Centres centres_;
  Diagnostics& diagnostics_;
  std::map<Key, std::optional<lower::Program>> programs_;
};

// One start of a task.
class InStart {
 public:
  InStart(Relations& relations, const Task& task, const Start& start);

  // As `denote` does, of where things are as well.
  Denotation denote(const Phrase& phrase, ObjectId wanted) const;
  // What keeps the phrase from describing the object here, in words; empty where it is not known.
  std::string lack(const Phrase& phrase, ObjectId wanted) const;

 private:
  Truth holds(const QueryOp& op, std::uint16_t described, const Alike& alike) const;

  Relations& relations_;
  const Task& task_;
  Scenery scenery_;
  std::vector<lower::PlacedBody> placed_;  // by body; left as made for those no phrase can denote
};

}  // namespace probe::sema

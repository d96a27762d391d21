// Trials of a search as episodes: which start and seed each has, whether that is fair, how it
// ended.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/run/episode.h"
#include "runtime/run/run.h"
#include "runtime/search/method/outcome.h"
#include "runtime/search/points_file.h"
#include "runtime/search/solved.h"

namespace probe::search {

// A trial of a point: the `number`-th of its kind there.
struct Trial {
  std::size_t point = 0;  // of the plan's points, or kBase
  std::uint64_t number = 0;
};

// Tells a method what its trials came to, and runs what it asks for.
class Trials {
 public:
  // The method, as numbers: what it asks now, empty when it is done; and its being told.
  struct Asking {
    std::function<Result<std::vector<Trial>>()> ask;
    std::function<void(std::span<const Outcome>)> tell;
  };

  // `options`: of the policy's run into its folder, which may hold episodes. `solved` may be null:
  // nothing is proved, then. `kind` names the draws of starts: another kind draws other ones.
  Trials(const BaseTask& base, const PlannedPoints& planned, run::RunOptions options,
         Solved* solved, std::uint64_t seed, std::string kind, int first_seed = 0);

  // This call's share: trials of others are left alone, and what they came to is told as far as it
  // is known, else as left out. What the method then finds is not to be told.
  void share(int shard, int shards) {
    shard_ = shard;
    shards_ = shards;
  }

  // What was asked next followed from how these trials ended: of an episode that a server spoiled
  // nothing else is to be told than was then.
  void mark_over() { is_over_ = true; }

  // Until the method is done. Fails as run() does; what was run until then is stored, and the same
  // call goes on.
  Status run(const Asking& asking);

  int episodes() const { return static_cast<int>(known_.size()); }  // that came to an end
  int ran() const { return ran_; }                                  // by this call
  int unfair() const { return unfair_; }    // trials whose point no start is fair of
  int invalid() const { return invalid_; }  // trials whose episodes count neither way
  std::string first_invalid() const;        // an episode of them and why; empty: none
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Place {
    std::uint32_t task = 0;
    std::size_t index = 0;  // of the plan's starts of it
    int seed = 0;
  };
  Result<std::vector<std::optional<Place>>> places_of(std::span<const Trial> trials);
  Result<std::vector<run::EpisodeJob>> advance();
  Status read_known();
  Status check_told() const;
  void keep(const store::ResultRow& row);
  Outcome outcome_of(const Place& place) const;

  const BaseTask& base_;
  const PlannedPoints& planned_;
  run::RunOptions options_;
  Solved* solved_;
  std::uint64_t seed_;
  std::string kind_;
  int first_seed_ = 0;
  int shard_ = 1, shards_ = 1;
  bool draws_ = false;
  const Asking* asking_ = nullptr;
  std::vector<std::optional<Place>> asked_;
  std::map<store::EpisodeKey, std::optional<bool>> known_;       // success; none: invalid
  std::map<store::EpisodeKey, std::string> lost_;                // invalid ones, and why
  bool is_over_ = false;
  int ran_ = 0, unfair_ = 0, invalid_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace probe::search

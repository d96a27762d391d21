// Which episode of a run: what rows, traces, videos and messages are found by.
#pragma once

#include <compare>
#include <string>

namespace probe::store {

struct EpisodeKey {
  std::string task;  // the plan's name, without a suite's prefix
  int episode = 0;   // within the task
  int seed = 0;
  auto operator<=>(const EpisodeKey&) const = default;
};

// Of whatever has these three: a row, a trace's header.
template <typename Of>
EpisodeKey key_of(const Of& of) {
  return {of.task, of.episode, of.seed};
}

// "carrot_on_plate episode 3 seed 42", as messages say it.
inline std::string to_text(const EpisodeKey& key) {
  return key.task + " episode " + std::to_string(key.episode) + " seed " + std::to_string(key.seed);
}

// Where a run's folder has what belongs to the episode: "TASK/EPISODE-SEED", below traces/ and
// videos/.
inline std::string file_stem(const EpisodeKey& key) {
  return key.task + "/" + std::to_string(key.episode) + "-" + std::to_string(key.seed);
}

}  // namespace probe::store

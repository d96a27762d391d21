#include "runtime/stats/questions.h"

#include <algorithm>

#include "runtime/stats/clustered.h"

namespace probe::stats {
namespace {

template <typename Unit>
Answer answer(std::span<const PlacedPairs> pairs, double confidence, Unit unit) {
  std::vector<StartPairs> rows;
  std::vector<Cluster> clusters;
  for (const PlacedPairs& row : pairs) {
    const std::uint32_t id = unit(row);
    rows.push_back({row.pairs, row.task, id});
    clusters.resize(std::max(clusters.size(), std::size_t{id} + 1));
    clusters[id] = clusters[id] + row.pairs;
  }
  Answer answer{clustered_difference(rows, confidence).interval, clustered_exact(clusters), {}};
  for (const Cluster& cluster : clusters) answer.nets.push_back(cluster.net());
  return answer;
}

}  // namespace

Answers ask(std::span<const PlacedPairs> pairs, double confidence) {
  PairTable all;
  for (const PlacedPairs& row : pairs) all = all + row.pairs;
  Answers answers;
  if (all.pairs() > 0)
    answers.difference = static_cast<double>(all.net()) / static_cast<double>(all.pairs());
  answers.here = answer(pairs, confidence, [](const PlacedPairs& row) { return row.start; });
  answers.anew = answer(pairs, confidence, [](const PlacedPairs& row) { return row.place; });
  return answers;
}

}  // namespace probe::stats

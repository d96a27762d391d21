#include "runtime/stats/here_and_anew.h"

#include <algorithm>

#include "runtime/stats/clustered.h"

namespace probe::stats {
namespace {

template <typename Unit>
Finding finding(std::span<const PlacedPairs> pairs, double confidence, Unit unit) {
  std::vector<StartPairs> rows;
  std::vector<Cluster> clusters;
  for (const PlacedPairs& row : pairs) {
    const std::uint32_t id = unit(row);
    rows.push_back({row.pairs, row.task, id});
    clusters.resize(std::max(clusters.size(), std::size_t{id} + 1));
    clusters[id] = clusters[id] + row.pairs;
  }
  Finding finding{clustered_difference(rows, confidence).interval, clustered_exact(clusters), {}};
  for (const Cluster& cluster : clusters) finding.nets.push_back(cluster.net());
  return finding;
}

}  // namespace

HereAndAnew compare_here_and_anew(std::span<const PlacedPairs> pairs, double confidence) {
  PairTable all;
  for (const PlacedPairs& row : pairs) all = all + row.pairs;
  HereAndAnew found;
  if (all.pairs() > 0)
    found.difference = static_cast<double>(all.net()) / static_cast<double>(all.pairs());
  found.here = finding(pairs, confidence, [](const PlacedPairs& row) { return row.start; });
  found.anew = finding(pairs, confidence, [](const PlacedPairs& row) { return row.place; });
  return found;
}

}  // namespace probe::stats

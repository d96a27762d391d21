// A round's points as they came out, kept beside its text: a search that goes on compiles nothing
// twice.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/search/points_file.h"

namespace probe::search {

// Knows which files of assets it has looked at: rounds share most of them.
class StoredPoints {
 public:
  explicit StoredPoints(const BaseTask& base) : base_(base) {}

  // Of these points what `keep` has written in `folder`. Nothing where it was written by another
  // program or of other points, texts or assets than there are now, or cannot be read: compiled
  // again it is right, or refused with its reason.
  std::optional<PlannedPoints> find(std::span<const PlannedPoint> points,
                                    const std::string& folder);
  // `points`: as they were before they were compiled. Fails (kIo) where it cannot be written.
  Status keep(std::span<const PlannedPoint> points, const PlannedPoints& planned,
              const std::string& folder) const;

 private:
  std::string key_of(std::span<const PlannedPoint> points) const;
  bool has_assets(const PlannedPoints& planned);

  const BaseTask& base_;
  std::set<std::pair<std::string, std::string>> same_;  // paths and hashes of files that are so
};

// Names of what `keep` writes: of one program and one place, so of no use in another.
bool is_stored_point_file(std::string_view name);

}  // namespace probe::search

// Rows of a policy server's answers of which it is not shown yet that one policy gave them: the
// table of folders that need it, so that older programs read the others.
#pragma once

#include <string_view>
#include <vector>

#include "runtime/store/database.h"
#include "runtime/store/episode_key.h"

namespace probe::store {

inline constexpr std::string_view kUnprovenColumns[] = {"task", "episode", "seed"};

class UnprovenTable {
 public:
  explicit UnprovenTable(Database& database) : database_(database) {}  // which must live as long

  // Makes the table where it is not there.
  Status make();
  Status add(const EpisodeKey& key);
  // Where the table is there.
  Status remove(const EpisodeKey& key);
  // Of these, those whose rows are valid; none where there is no table.
  Result<std::vector<EpisodeKey>> valid();
  Status clear();

 private:
  Result<bool> is_there();

  Database& database_;
};

}  // namespace probe::store

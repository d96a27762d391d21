// The order in which a run that stops by what it finds takes its episodes: the table of such folders
// alone, so that older programs read the others.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "runtime/store/database.h"
#include "runtime/store/store.h"

namespace probe::store {

// `other`: 1 where the run that it is compared with succeeded, 0 where not, else null.
inline constexpr std::string_view kOrderColumns[] = {"place", "task", "episode", "seed", "other"};

class OrderTable {
 public:
  explicit OrderTable(Database& database) : database_(database) {}  // which must live as long

  // None where there is no table.
  Result<std::vector<OrderedEpisode>> read();
  // Makes the table.
  Status write(std::span<const OrderedEpisode> order);
  Status clear();

 private:
  Result<bool> is_there();

  Database& database_;
};

}  // namespace probe::store

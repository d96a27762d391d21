// What policies of ours say of episodes in which they did not do all that they meant to: the table
// of folders that need it, so that older programs read the others.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/store/database.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/results.h"

namespace probe::store {

inline constexpr std::string_view kRemarkColumns[] = {"task", "episode", "seed", "remark"};

class RemarksTable {
 public:
  explicit RemarksTable(Database& database) : database_(database) {}  // which must live as long

  // In the place of what was said of the episode before; makes the table where it is needed.
  Status put(const EpisodeKey& key, const std::optional<std::string>& remark);
  // Gives each of these rows of one task, ascending by episode and seed, what was said of it.
  Status add_to(std::span<ResultRow> rows);

 private:
  Result<bool> is_there();

  Database& database_;
};

}  // namespace probe::store

// Plans whose parts say links that the compiler would not have written.
#pragma once

#include <doctest/doctest.h>

#include "runtime/plan/plan.h"
#include "tests/plan/defects.h"

namespace probe::plan {

// The plan with `part` on the link that `link` names; its hashes are right.
inline Plan with_link(std::vector<std::byte> bytes, std::size_t part, StringRef link) {
  const std::vector<DirectoryEntry> directory = read_directory(bytes);
  const auto entry =
      std::ranges::find(directory, static_cast<std::uint32_t>(Section::kParts),
                        [](const DirectoryEntry& e) { return static_cast<std::uint32_t>(e.kind); });
  REQUIRE(entry != directory.end());
  REQUIRE(part < entry->count);
  std::byte* const at = bytes.data() + entry->offset + part * sizeof(PartRecord);
  PartRecord record;
  std::memcpy(&record, at, sizeof record);
  record.link = link;
  std::memcpy(at, &record, sizeof record);
  seal(bytes, directory);
  auto plan = Plan::from_bytes(std::move(bytes));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
  return std::move(*plan);
}

}  // namespace probe::plan

// Other words for instructions, from a table that `vlaprobe rephrase` wrote, and which of them a
// demonstration is told in.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::dataset {

class Wordings {
 public:
  // Of a .jsonl table; only the split `train` is read. Fails with kIo, or with kUsage naming the
  // line that is no line of such a table.
  static Result<Wordings> read(const std::string& path);

  // An instruction of a task in these starts (plan::starts_hash): where others lie around it, the
  // same words may mean something else.
  struct Told {
    std::string task, instruction, starts_sha256;
    auto operator<=>(const Told&) const = default;
  };
  bool has(const Told& told) const;
  // Whether there are words for it in other starts.
  bool has_for_other_starts(const Told& told) const;
  // `count` of them without one twice, or all there are: drawn by their probabilities, the
  // instruction itself among them, from `key` alone. Without words for it the instruction.
  std::vector<std::string> draw(const Told& told, int count, std::string_view key) const;
  const std::string& sha256() const { return sha256_; }  // of the file

 private:
  struct Choice {
    std::string text;
    double probability = 0;
  };
  std::map<Told, std::vector<Choice>> choices_;
  std::string sha256_;
};

}  // namespace probe::dataset

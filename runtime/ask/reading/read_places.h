// Places of an answer that say of themselves that they hold it: one row one place, in the order in
// which they are looked for.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/read_answer.h"

namespace probe::ask {

// Where a part that answers stands in the text around it.
struct FoundPart {
  std::string text;
  std::size_t begin = 0, end = 0;  // bytes, with its marks
  bool closed = true;              // its end is marked, too
};

struct Place {
  RuleInfo info;
  bool says_its_end = true;  // a tag, a box, JSON; a line of words ends where it ends
  std::vector<FoundPart> (*find)(const ReadContext& context, std::string_view text);
};
std::span<const Place> answer_places();

}  // namespace probe::ask

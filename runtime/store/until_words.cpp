#include "runtime/store/until_words.h"

#include "runtime/base/printable.h"
#include "runtime/store/run_record.h"

namespace probe::store {
namespace {

constexpr std::size_t kLongest = 200;

}  // namespace

bool is_by_search(const std::string& until) { return until == kBySearch; }

std::string what_chose(const std::string& until) {
  if (is_by_search(until)) return "is of a search, which chose its episodes by what it found";
  return "stopped by what it found (" + printable(until, kLongest) + ")";
}

std::string way_out(const std::string& until) {
  if (is_by_search(until))
    return "a search has no others to run; `vlaprobe search show DIR` says what it found";
  return "`run --until none` runs the others";
}

}  // namespace probe::store

// What is said of a folder whose episodes depend on how they ended (RunIdentity::until), by whoever
// refuses it or shows no rates of it. Fit for a terminal: the folder may be somebody else's.
#pragma once

#include <string>

namespace probe::store {

bool is_by_search(const std::string& until);

// Behind the folder's name: "stopped by what it found (width 10 % of each task)", "is of a search, which
// chose its episodes by what it found".
std::string what_chose(const std::string& until);

// What whoever wants rates can do: "`run --until none` runs the others", or of a search, which has no
// others, where its findings are.
std::string way_out(const std::string& until);

}  // namespace probe::store

// Where a folder of ours, as of a run, is written: inside of it alone. Whoever sent the folder may
// have put links into it; a link that the user names with -o is followed, one below it never.
#pragma once

#include <string>

#include "runtime/base/result.h"

namespace probe {

// `below`, relative to `folder`, and each folder on the way to it: none is a link. What is not
// there is none. Fails (kIo, where = the link).
Status check_inside(const std::string& folder, const std::string& below);

// folder/below, for a file that is about to be written: check_inside() of the folders on the way,
// and a link in its own place is taken away, so that the file takes that place and what the link
// points to stays as it is. Fails as that, and where the link cannot be removed.
Result<std::string> file_inside(const std::string& folder, const std::string& below);

// check_inside(), and of all that lies in folder/below, too: for folders that have files of ours
// alone.
Status check_all_inside(const std::string& folder, const std::string& below);

}  // namespace probe

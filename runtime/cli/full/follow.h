// `results --follow` and `run --watch`: a run told of while somebody writes it.
#pragma once

#include <string>

namespace probe::cli {

// Until the run is done or the user leaves: lines drawn anew on a terminal, one line now and then
// elsewhere, objects of JSON. `port`: of a page beside it; empty: none. The exit code.
int follow_run(const std::string& dir, bool json, const std::string& port);

}  // namespace probe::cli

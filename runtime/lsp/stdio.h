// The server over a pair of files, as an editor starts it: messages on one, answers on the other.
#pragma once

#include "runtime/lsp/server.h"

namespace probe::lsp {

// Until `exit`, the end of the input, or nobody reads the output any more. The exit code of the
// program. `in` and `out` are file descriptors.
Result<int> serve(int in, int out, const ServerOptions& options);

}  // namespace probe::lsp

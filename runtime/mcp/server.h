// The Model Context Protocol over a pair of files: a message a line (JSON-RPC 2.0), as coding agents
// start a server. Knows nothing of what tools do.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/mcp/tools.h"

namespace probe::mcp {

// The answer to one message as a line without its end; nothing to a notification. Of what is no
// message the answer says so.
std::optional<std::string> answer(Tools& tools, std::string_view message);

// Until the end of the input, or nobody reads the output any more.
void serve(int in, int out, Tools& tools);

}  // namespace probe::mcp

// What is answered to each request about texts: the method's parameters in, its result out.
#pragma once

#include <string_view>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/lsp/workspace.h"

namespace probe::lsp {

// What the editor can take.
struct Client {
  bool has_related = false;    // other places of a diagnostic
  bool pulls = false;          // asks for diagnostics by itself
  bool refreshes = false;      // can be told to ask again: diagnostics
  bool refreshes_hints = false, refreshes_lenses = false, refreshes_tokens = false;
  bool watches = false;        // can be asked to watch files
  bool has_hierarchy = false;  // symbols as a tree
  bool has_snippets = false;
};

// The result, a Failure to answer with, or nothing: no such method.
using Answer = Result<Json> (*)(Workspace&, const Client&, const Json& params);
Answer find_answer(std::string_view method);

// What `initialize` says that the server can do.
Json capabilities();

}  // namespace probe::lsp

// The language server behind the editor of the page: `lsp::Server` over a WebSocket, for texts of
// one folder.
#pragma once

#include <memory>

#include "runtime/lsp/server.h"
#include "runtime/studio/folder.h"
#include "runtime/wire/page_listener.h"

namespace probe::studio {

// Fails as lsp::Server::start() does. `folder` outlives it.
Result<std::unique_ptr<wire::Ear>> make_text_ear(const Folder& folder,
                                                 const lsp::ServerOptions& options,
                                                 std::shared_ptr<wire::Mouth> mouth);

}  // namespace probe::studio

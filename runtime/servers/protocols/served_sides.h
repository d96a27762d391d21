// The servers' sides of the protocols, for their rows.
#pragma once

#include "runtime/servers/served.h"

namespace probe::servers {

Result<std::unique_ptr<wire::Listener>> serve_openpi(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_intact(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_roboarena(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_vlaeval(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_gr00t(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_openvla(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_starvla(const ServeOptions& options);
Result<std::unique_ptr<wire::Listener>> serve_lerobot(const ServeOptions& options);

}  // namespace probe::servers

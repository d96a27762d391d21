// `vlaprobe studio`: a page on this machine that shows a text while it is written.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::studio {

struct StudioOptions {
  std::string file;             // the text; it need not be there yet
  AssetRoot assets;             // as of compile::FilesRequest
  std::string library;
  std::string port = "0";       // 0: any free one
};

class Studio {
 public:
  // Listens on 127.0.0.1 until it goes. Fails (kUsage) on a text that is none, a port that is
  // taken, and as find_asset_root() and find_library_folders() do.
  static Result<std::unique_ptr<Studio>> start(const StudioOptions& options);
  virtual ~Studio() = default;

  // With the token: "http://127.0.0.1:40123/1f9c.../".
  virtual std::string address() const = 0;
};

}  // namespace probe::studio

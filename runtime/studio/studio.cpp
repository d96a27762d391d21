#include "runtime/studio/studio.h"

#include "runtime/base/asset_root.h"
#include "runtime/compile/library.h"
#include "runtime/studio/gate.h"
#include "runtime/studio/live_ear.h"
#include "runtime/studio/page_files.h"
#include "runtime/studio/text_ear.h"

namespace probe::studio {
namespace {

constexpr char kAddress[] = "127.0.0.1";

// The page's own scripts alone run, and it speaks with nobody but us. Monaco styles its lines by
// attributes.
constexpr char kPolicy[] =
    "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self' 'unsafe-inline'; "
    "font-src 'self'; img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

wire::Page page_of(std::string_view path) {
  if (path.empty()) path = "index.html";
  for (const PageFile& file : page_files()) {
    if (file.name != path) continue;
    wire::Page page{200, std::string(file.type), "", {}};
    for (const std::string_view piece : file.gzip) page.body += piece;
    page.headers = {{"Content-Encoding", "gzip"},
                    {"Content-Security-Policy", kPolicy},
                    {"Cross-Origin-Resource-Policy", "same-origin"},
                    {"Cross-Origin-Opener-Policy", "same-origin"},
                    {"Referrer-Policy", "no-referrer"},
                    {"X-Content-Type-Options", "nosniff"},
                    {"Cache-Control", "no-store"}};
    return page;
  }
  return {404, "text/plain", "vlaprobe studio: there is no such page\n", {}};
}

class Served final : public Studio {
 public:
  Served(StudioOptions options, std::unique_ptr<Folder> folder, std::string token)
      : options_(std::move(options)), folder_(std::move(folder)), gate_{std::move(token), ""} {}

  Status listen() {
    wire::PageRules rules;
    rules.refuse = [this](const wire::Visit& visit) { return gate().refuse(visit); };
    rules.page = [this](const wire::Visit& visit) { return page_of(gate().path(visit.target)); };
    rules.talk = [this](const wire::Visit& visit, std::shared_ptr<wire::Mouth> mouth) {
      return talk(gate().path(visit.target), std::move(mouth));
    };
    PROBE_ASSIGN(listener_, wire::listen_pages(kAddress, options_.port, std::move(rules)));
    const std::lock_guard lock(mutex_);
    gate_.port = listener_->port();
    return {};
  }

  std::string address() const override {
    return std::string("http://") + kAddress + ":" + gate_.port + "/" + gate_.token + "/";
  }

 private:
  // The port is known when somebody may be asking already.
  Gate gate() const {
    const std::lock_guard lock(mutex_);
    return gate_;
  }

  std::unique_ptr<wire::Ear> talk(std::string_view path, std::shared_ptr<wire::Mouth> mouth) {
    if (path == "live") {
      return make_live_ear(*folder_, seat_, {folder_->file(), options_.assets, options_.library},
                           std::move(mouth));
    }
    if (path == "text") {
      auto ear = make_text_ear(*folder_, {.assets = options_.assets, .library = options_.library},
                               std::move(mouth));
      if (ear) return std::move(*ear);
    }
    return nullptr;
  }

  const StudioOptions options_;
  const std::unique_ptr<Folder> folder_;
  Seat seat_;
  mutable std::mutex mutex_;  // gate_
  Gate gate_;
  std::unique_ptr<wire::Listener> listener_;  // the last: it ends before what it answers from
};

}  // namespace

Result<std::unique_ptr<Studio>> Studio::start(const StudioOptions& options) {
  // What a page would have to be told later is said here.
  PROBE_TRY(find_asset_root(options.assets));
  PROBE_TRY(compile::find_library_folders(options.library));
  PROBE_ASSIGN(auto folder, Folder::of(options.file));
  PROBE_ASSIGN(std::string token, make_token());
  auto studio = std::make_unique<Served>(options, std::move(folder), std::move(token));
  PROBE_TRY(studio->listen());
  return std::unique_ptr<Studio>(std::move(studio));
}

}  // namespace probe::studio

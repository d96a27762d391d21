#include "runtime/follow/page.h"

#include <chrono>
#include <mutex>

#include "runtime/follow/follow.h"
#include "runtime/studio/gate.h"
#include "runtime/wire/page_listener.h"

namespace probe::follow {
namespace {

constexpr char kAddress[] = "127.0.0.1";

// Its own script alone runs, and it speaks with nobody but us.
constexpr char kPolicy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

constexpr char kHtml[] = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>vlaprobe</title><link rel="stylesheet" href="page.css"></head>
<body><main><h1 id="dir"></h1><p id="counts" role="status"></p>
<progress id="bar" max="1" value="0" aria-label="episodes that are there"></progress>
<table><caption>Valid episodes; rates have 95 % intervals where all that were chosen are run</caption><tbody id="rates"></tbody></table>
<h2>Newest failures</h2><ol id="newest"></ol><p id="trouble" role="alert"></p></main>
<script src="page.js"></script></body></html>
)html";

constexpr char kCss[] = R"css(:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.3rem; overflow-wrap: anywhere; } h2 { font-size: 1.1rem; }
progress { width: 100%; } table { border-collapse: collapse; } caption { text-align: left; }
td { padding: .15rem 1.2rem .15rem 0; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
code { display: block; overflow-wrap: anywhere; } #trouble { color: #b3261e; }
)css";

// Texts of a folder are set as text and never as markup.
constexpr char kScript[] = R"js("use strict";
const at = (id) => document.getElementById(id);
const made = (kind, text, kindOf) => { const e = document.createElement(kind); e.textContent = text; if (kindOf) e.className = kindOf; return e; };
function draw(run) {
  document.title = run.chosen ? `${Math.floor(100 * run.episodes / run.chosen)} % ${run.dir}` : run.dir;
  at("dir").textContent = run.dir;
  const parts = [`${run.episodes.toLocaleString("en")}${run.chosen ? ` of ${run.until ? "at most " : run.is_about ? "about " : ""}${run.chosen.toLocaleString("en")}` : ""} episodes`];
  if (run.shards && run.begun < run.shards) parts.push(`${run.begun} of ${run.shards} shards begun`);
  if (run.merged) parts.push(`${run.merged} of ${run.shards} shards merged and removed`);
  if (run.not_attempted) parts.push(`${run.not_attempted} not attempted`);
  if (run.invalid) parts.push(`${run.invalid} invalid`);
  if (run.is_done) parts.push("done");
  else if (run.per_minute) parts.push(`${run.per_minute.toFixed(1)} a minute`);
  if (!run.is_done && run.left !== null) parts.push(`${run.left} left`);
  at("counts").textContent = parts.join(", ");
  at("bar").value = run.chosen ? Math.min(1, run.episodes / run.chosen) : 0;
  at("rates").replaceChildren(...run.rates.map((rate) => {
    const row = document.createElement("tr");
    row.append(made("td", rate.name), made("td", `${rate.k} of ${rate.n}`, "number"), made("td", rate.n && rate.low !== undefined ? `${(100 * rate.k / rate.n).toFixed(1)} %` : "", "number"),
      made("td", rate.low === undefined ? "" : `${(100 * rate.low).toFixed(1)} to ${(100 * rate.high).toFixed(1)}`, "number"));
    return row;
  }));
  at("newest").replaceChildren(...run.newest_failures.map((one) => {
    const item = document.createElement("li");
    item.append(made("span", `${new Date(1000 * one.ended).toLocaleTimeString()} ${one.task} episode ${one.episode} seed ${one.seed}: ${one.why}`),
      made("code", one.command));
    return item;
  }));
}
async function look() {
  let wait = 2000;
  try {
    const begun = performance.now();
    const answer = await fetch("run.json");
    const run = await answer.json();
    if (!answer.ok) throw new Error(run.trouble);
    draw(run);
    at("trouble").textContent = "";
    wait = Math.max(wait, 10 * (performance.now() - begun));
  } catch (error) {
    at("trouble").textContent = `${error.message}; trying again`;
  }
  setTimeout(look, wait);
}
look();
)js";

class Served final : public FollowPage {
 public:
  Served(const std::string& dir, std::string token)
      : following_(dir), gate_{std::move(token), ""} {}

  Status listen(const std::string& port) {
    wire::PageRules rules;
    rules.refuse = [this](const wire::Visit& visit) { return gate().refuse(visit); };
    rules.page = [this](const wire::Visit& visit) {
      wire::Page page = page_of(gate().path(visit.target));
      page.headers = {{"Content-Security-Policy", kPolicy},
                      {"Cross-Origin-Resource-Policy", "same-origin"},
                      {"Referrer-Policy", "no-referrer"},
                      {"X-Content-Type-Options", "nosniff"},
                      {"Cache-Control", "no-store"}};
      return page;
    };
    PROBE_ASSIGN(listener_, wire::listen_pages(kAddress, port, std::move(rules)));
    const std::lock_guard lock(mutex_);
    gate_.port = listener_->port();
    return {};
  }

  std::string address() const override {
    const studio::Gate here = gate();
    return std::string("http://") + kAddress + ":" + here.port + "/" + here.token + "/";
  }

 private:
  // The port is known when somebody may be asking already.
  studio::Gate gate() const {
    const std::lock_guard lock(mutex_);
    return gate_;
  }

  wire::Page page_of(std::string_view path) {
    if (path.empty()) return {200, "text/html; charset=utf-8", kHtml, {}};
    if (path == "page.css") return {200, "text/css", kCss, {}};
    if (path == "page.js") return {200, "text/javascript", kScript, {}};
    if (path != "run.json") return {404, "text/plain", "vlaprobe: there is no such page\n", {}};
    const std::lock_guard lock(looking_);
    const double now =
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    const auto seen = following_.look(now);
    if (seen) return {200, "application/json", to_json(*seen).dump(), {}};
    const Json trouble = {{"trouble", to_text(seen.failure())}};
    return {500, "application/json", trouble.dump(), {}};
  }

  std::mutex looking_;
  Following following_;
  mutable std::mutex mutex_;  // gate_
  studio::Gate gate_;
  std::unique_ptr<wire::Listener> listener_;  // the last: it ends before what it answers from
};

}  // namespace

Result<std::unique_ptr<FollowPage>> FollowPage::start(const std::string& dir,
                                                      const std::string& port) {
  PROBE_ASSIGN(std::string token, studio::make_token());
  auto page = std::make_unique<Served>(dir, std::move(token));
  PROBE_TRY(page->listen(port));
  return std::unique_ptr<FollowPage>(std::move(page));
}

}  // namespace probe::follow

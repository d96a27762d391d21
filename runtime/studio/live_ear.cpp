#include "runtime/studio/live_ear.h"

#include "runtime/base/json.h"
#include "runtime/lsp/uri.h"
#include "runtime/run/policies.h"
#include "runtime/studio/message.h"
#include "runtime/studio/player.h"

namespace probe::studio {
namespace {

Json refused(const Failure& failure) {
  return {{"kind", "refused"}, {"message", to_text(failure)}, {"path", failure.where}};
}

std::int64_t whole(const Json& json, const char* key) {
  const Json* found = json.find(key);
  if (found == nullptr || !found->is_number()) return 0;
  const double number = found->get<double>();
  return number > -1e15 && number < 1e15 ? static_cast<std::int64_t>(number) : 0;
}

std::uint32_t count(const Json& json, const char* key) {
  const std::int64_t number = whole(json, key);
  return number >= 0 && number < plan::kNone ? static_cast<std::uint32_t>(number) : 0;
}

class LiveEar final : public wire::Ear {
 public:
  LiveEar(Folder& folder, Seat& seat, Setting setting, std::shared_ptr<wire::Mouth> mouth)
      : folder_(folder),
        seat_(seat),
        mouth_(std::move(mouth)),
        painter_(std::move(setting),
                 [mouth = mouth_](wire::Frame frame) { mouth->say(std::move(frame)); }),
        player_([mouth = mouth_](wire::Frame frame) { mouth->say(std::move(frame)); },
                [mouth = mouth_] { return mouth->unread(); }) {}
  ~LiveEar() override { seat_.leave(mouth_); }

  void hear(const wire::Frame& frame) override {
    const Json json = Json::parse(
        std::string_view(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()));
    if (!json.is_object())
      return say({{"kind", "refused"}, {"message", "a message that is no JSON object"}});
    const std::string what = json.value("do", "");
    if (what == "hello") {
      if (!seat_.take(mouth_)) return say({{"kind", "taken"}});
      return welcome();
    }
    if (what == "take") {
      seat_.take_over(mouth_);
      return welcome();
    }
    // What a page said before another took over may still come.
    if (!seat_.is_of(mouth_))
      return say({{"kind", "refused"}, {"message", "another page shows this studio"}});
    if (what == "open") return open(json.value("path", ""));
    if (what == "save") return save(json);
    if (what == "news") return news(json);
    if (what == "show") return show(json);
    if (what == "play") return play(json);
    if (what == "stop") return player_.stop();
    if (what == "look") return player_.look(static_cast<int>(count(json, "step")));
    if (what == "keep") return keep(static_cast<int>(count(json, "step")));
    if (what == "why") return player_.why(json.value("metric", ""));
    say({{"kind", "refused"}, {"message", "there is no `" + what + "`"}});
  }

 private:
  void say(const Json& json) { mouth_->say(message(json)); }

  void welcome() {
    Json texts = Json::array();
    for (const std::string& path : folder_.texts()) texts.push_back(path);
    say({{"kind", "welcome"},
         {"file", folder_.file()},
         {"uri", lsp::uri_of(folder_.file())},
         {"folder", folder_.root()},
         {"texts", std::move(texts)},
         {"policies", run::policy_help()}});
  }

  void open(const std::string& path) {
    auto text = folder_.open(path);
    if (!text) return say(refused(text.failure()));
    say({{"kind", "text"},
         {"path", path},
         {"uri", lsp::uri_of(path)},
         {"text", std::move(text->text)},
         {"is_new", text->is_new}});
  }

  void save(const Json& json) {
    const std::string path = json.value("path", "");
    const Json* text = json.find("text");
    if (text == nullptr || !text->is_string())
      return say({{"kind", "refused"}, {"message", "`save` needs a `text`"}, {"path", path}});
    const Json* over = json.find("over");
    const bool is_over = over != nullptr && over->is_boolean() && over->get<bool>();
    if (auto saved = folder_.save(path, text->text(), is_over); !saved)
      return say(refused(saved.failure()));
    say({{"kind", "saved"}, {"path", path}});
  }

  void news(const Json& json) {
    const Json* paths = json.find("paths");
    if (paths == nullptr || !paths->is_array()) return;
    for (const Json& path : *paths) {
      if (!path.is_string()) continue;
      const Folder::News news = folder_.news(path.text());
      if (news == Folder::News::kNone) continue;
      say({{"kind", "news"},
           {"path", path.text()},
           {"what", news == Folder::News::kGone ? "gone" : "changed"}});
    }
  }

  void show(const Json& json) {
    Wish wish;
    wish.id = whole(json, "id");
    wish.task = json.value("task", "");
    wish.start = count(json, "start");
    if (const Json* texts = json.find("texts")) {
      for (const auto& [path, text] : texts->items()) {
        if (folder_.has(path) && text.is_string()) wish.texts[path] = text.text();
      }
    }
    painter_.wish(std::move(wish));
  }

  void play(const Json& json) {
    auto shown = painter_.shown();
    if (shown == nullptr)
      return say({{"kind", "stopped"}, {"message", "the text has to check before it is played"}});
    player_.play(std::move(shown), {json.value("task", ""), json.value("policy", "expert"),
                                    count(json, "start"), static_cast<int>(count(json, "seed"))});
  }

  // A start of its own, with the lines that use it, which the editor adds.
  void keep(int step) {
    const auto start = player_.start_at(step);
    if (!start)
      return say({{"kind", "refused"}, {"message", "there is no episode with such a step"}});
    const auto number = folder_.keep_table(start->table);
    if (!number) return say(refused(number.failure()));
    const std::string kept = "kept_" + std::to_string(*number);
    say({{"kind", "kept"},
         {"table", folder_.table_name(*number)},
         {"task", start->task + "_" + kept},
         {"lines", "layout " + kept + " { starts \"" + folder_.table_name(*number) +
                       "\"; drop none }\ntask " + start->task + "_" + kept + " like " +
                       start->task + " { layout " + kept + " }\n"}});
  }

  Folder& folder_;
  Seat& seat_;
  const std::shared_ptr<wire::Mouth> mouth_;
  Painter painter_;
  Player player_;
};

}  // namespace

bool Seat::take(const std::shared_ptr<wire::Mouth>& mouth) {
  const std::lock_guard lock(mutex_);
  if (taken_ != nullptr && taken_ != mouth) return false;
  taken_ = mouth;
  return true;
}

void Seat::take_over(const std::shared_ptr<wire::Mouth>& mouth) {
  const std::lock_guard lock(mutex_);
  if (taken_ != nullptr && taken_ != mouth) {
    taken_->say(message({{"kind", "lost"}}));
    taken_->end("another page took over");
  }
  taken_ = mouth;
}

void Seat::leave(const std::shared_ptr<wire::Mouth>& mouth) {
  const std::lock_guard lock(mutex_);
  if (taken_ == mouth) taken_.reset();
}

bool Seat::is_of(const std::shared_ptr<wire::Mouth>& mouth) const {
  const std::lock_guard lock(mutex_);
  return taken_ == mouth;
}

std::unique_ptr<wire::Ear> make_live_ear(Folder& folder, Seat& seat, const Setting& setting,
                                         std::shared_ptr<wire::Mouth> mouth) {
  return std::make_unique<LiveEar>(folder, seat, setting, std::move(mouth));
}

}  // namespace probe::studio

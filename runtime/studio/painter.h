// From a text as it is while it is typed to what is to be seen of it: compiled, its first picture
// small and then whole, its tasks, its starts from above. The newest wish alone is worked on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "runtime/base/asset_root.h"
#include "runtime/stage/stage.h"
#include "runtime/studio/shown.h"
#include "runtime/wire/listener.h"

namespace probe::studio {

struct Setting {
  std::string file;    // the text to show
  AssetRoot assets;  // as of compile::FilesRequest
  std::string library;
};

struct Wish {
  std::int64_t id = 0;                       // of its answers
  std::map<std::string, std::string> texts;  // what is not saved, by path
  std::string task;                          // empty, or one that is not there: the first
  std::uint32_t start = 0;                   // one that is not there: the first
};

// Answers, in this order, each with the wish's `id`:
//   {kind: "broken", errors, message, file, line, column}        and nothing after it
//   picture {kind: "picture", task, start, size: "small" | "full"}
//   {kind: "tasks", task, summary}                               when the text is another
//   {kind: "top", task, svg} or {kind: "top", task, message}     when text or task are others
//   {kind: "failed", task, message}                              in place of a picture
class Painter {
 public:
  using Tell = std::function<void(wire::Frame)>;

  Painter(Setting setting, Tell tell) : setting_(std::move(setting)), tell_(std::move(tell)) {}
  ~Painter();

  void wish(Wish wish);
  // The last text that was compiled; null: none was.
  std::shared_ptr<const Shown> shown() const;

 private:
  void run();
  void paint(const Wish& wish);
  bool is_changed_on_disk() const;
  bool compile(const Wish& wish);
  Status draw(const Wish& wish, std::uint32_t task);
  void draw_top(const Wish& wish, std::uint32_t task);
  void say(const Wish& wish, Json json) const;

  const Setting setting_;
  const Tell tell_;
  mutable std::mutex mutex_;  // next_, ends_, shown_
  std::condition_variable wakes_;
  std::optional<Wish> next_;
  bool ends_ = false;
  std::atomic<bool> stop_ = false;  // what is worked on is not wanted any more
  std::shared_ptr<const Shown> shown_;
  // Of the thread alone: what it told last, and its world.
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::string> read_;  // the files of that text, as they were
  bool is_told_ = false;
  std::string top_of_;
  struct Loaded {
    std::shared_ptr<const Shown> shown;  // outlives the stages
    std::uint32_t task = 0;
    std::shared_ptr<const stage::SharedAssets> assets;
    std::unique_ptr<stage::Stage> small, full;
  };
  std::unique_ptr<Loaded> loaded_;
  std::thread thread_;
};

}  // namespace probe::studio

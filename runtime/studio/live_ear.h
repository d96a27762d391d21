// What the page asks of the studio: texts of the folder, pictures, episodes. Every message is a
// JSON object whose `do` says what; an answer's `kind` says of what it is.
#pragma once

#include <functional>
#include <memory>

#include "runtime/studio/folder.h"
#include "runtime/studio/painter.h"
#include "runtime/wire/page_listener.h"

namespace probe::studio {

// Only one page at a time shows a studio.
class Seat {
 public:
  // False: another page sits there.
  bool take(const std::shared_ptr<wire::Mouth>& mouth);
  // Whoever sits there is told and goes.
  void take_over(const std::shared_ptr<wire::Mouth>& mouth);
  void leave(const std::shared_ptr<wire::Mouth>& mouth);
  bool is_of(const std::shared_ptr<wire::Mouth>& mouth) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<wire::Mouth> taken_;
};

// do: hello, take, open {path}, save {path, text, over}, news {paths}, show {id, texts, task,
// start}, play {task, start, policy, seed}, stop, look {step}, keep {step}, why {metric}.
std::unique_ptr<wire::Ear> make_live_ear(Folder& folder, Seat& seat, const Setting& setting,
                                         std::shared_ptr<wire::Mouth> mouth);

}  // namespace probe::studio

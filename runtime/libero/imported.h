// A folder that `libero import` made, for those who measure it: its suites as plans, its tasks as
// stages.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/stage.h"

namespace probe::libero {

class Imported {
 public:
  explicit Imported(std::string folder) : folder_(std::move(folder)) {}

  const std::string& folder() const { return folder_; }
  // Compiled once; lives as long as this. Fails (kUsage, where = the text) where the folder lacks
  // it or it does not check.
  Result<const plan::Plan*> plan(std::string_view suite);
  // Fails (kUsage) where the folder has no suite at all, so that it is no import.
  Status check() const;
  // Whether the folder has the task: a suite of which no task could be imported has no text.
  Result<bool> has(std::string_view suite, std::string_view task);
  // Of a task by its name in the text.
  Result<std::shared_ptr<const stage::SharedAssets>> assets(std::string_view suite,
                                                            std::string_view task);
  Result<std::unique_ptr<stage::Stage>> stage(std::string_view suite, std::string_view task,
                                              const stage::StageOptions& options);

 private:
  std::string text_of(std::string_view suite) const;
  Result<std::uint32_t> find(const plan::Plan& plan, std::string_view suite,
                             std::string_view task) const;

  std::string folder_;
  std::map<std::string, std::unique_ptr<plan::Plan>, std::less<>> plans_;
};

}  // namespace probe::libero

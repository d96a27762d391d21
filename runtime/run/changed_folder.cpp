#include "runtime/run/changed_folder.h"

namespace probe::run {

Result<bool> goes_on(const std::string& dir, const FolderChanges& changes, IfChanged if_changed,
                     std::vector<std::string>& notes) {
  std::string said;
  for (const std::string& change : {changes.identity, changes.content, changes.build}) {
    if (!change.empty()) said += (said.empty() ? "" : ", and ") + change;
  }
  if (if_changed == IfChanged::kFork) {
    notes.push_back(dir + " " + said + ": left as it is");
    return false;
  }
  const bool may_continue = changes.identity.empty();
  if (if_changed == IfChanged::kContinue && may_continue) {
    notes.push_back(dir + " " + said + ": continued all the same");
    return true;
  }
  return Failure{
      Fault::kStore,
      said + "; take another folder, or --if-changed fork, which starts one beside it" +
          (may_continue ? ", or --if-changed continue, which mixes them in this one" : ""),
      dir};
}

Status goes_on_mixed(const std::string& dir, const std::string& said, IfChanged if_changed,
                     std::vector<std::string>& notes, const std::string& also) {
  if (if_changed == IfChanged::kContinue) {
    notes.push_back(dir + " " + said + ": continued all the same");
    return {};
  }
  return Failure{Fault::kStore,
                 said +
                     "; take another folder, or --if-changed continue, which mixes them in this "
                     "one" +
                     also,
                 dir};
}

}  // namespace probe::run

// vlaprobe completion, vlaprobe manual: what the help says, as shells and man read it.
#include "runtime/base/say.h"
#include "runtime/cli/completion_text.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cli/manual_text.h"

namespace probe::cli {

void add_completion(Verb app, int& exit) {
  auto shell = std::make_shared<std::string>();
  Verb verb = app.add_subcommand("completion", "a script by which a shell completes verbs and options");
  verb.footer("example: source <(vlaprobe completion bash)   # zsh: > ${fpath[1]}/_vlaprobe");
  verb.add_option("SHELL", *shell, "the shell").required().one_of({"bash", "zsh", "fish"});
  verb.callback([app, shell, &exit] {
    const VerbText program = app.text();
    put("{}", *shell == "bash"  ? bash_completion(program)
              : *shell == "zsh" ? zsh_completion(program)
                                : fish_completion(program));
    exit = kFine;
  });
}

void add_manual(Verb app, int& exit) {
  Verb verb = app.add_subcommand("manual", "every verb and option as a manual page");
  auto verbs = std::make_shared<bool>(false);
  verb.footer("example: vlaprobe manual >vlaprobe.1 && man ./vlaprobe.1");
  verb.add_flag("--verbs", *verbs, "the verbs alone, as a table of Markdown");
  verb.callback([app, verbs, &exit] {
    put("{}", *verbs ? verb_table(app.text()) : manual_page(app.text(), version()));
    exit = kFine;
  });
}

}  // namespace probe::cli

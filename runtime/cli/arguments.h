// The command line as the verbs see it: options bound to their own variables, help texts and
// checks. What parses it (CLI11, seconds of compiling wherever it is included) is behind
// arguments.cpp alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace probe::cli {

// An option or positional that was just added. A view: the verb owns it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  // Of a list: "a,b" is two values.
  Option& delimiter(char separator);
  // Of a list: every use of the option takes one value, and all uses count.
  Option& one_each();
  // Of a list: a use of the option takes one value, so that positionals may follow.
  Option& no_extra_values();
  // Anything else is refused, and the help says so.
  Option& between(int low, int high);
  Option& one_of(std::vector<std::string> words);
  Option& excludes(const Option& other);

 private:
  CLI::Option* option_;
};

// What the help says of an option: "-o", "--out"; of a positional its name alone. `values` are the words it takes,
// where those are few and known.
struct OptionText {
  std::vector<std::string> names;
  std::string about;
  bool is_positional = false, takes_value = false;
  std::vector<std::string> values;
};

// What the help says of the program or a verb; options without a word about them are left out, as there.
struct VerbText {
  std::string name, about, footer;
  std::vector<OptionText> options;
  std::vector<VerbText> verbs;
};

// The program or one of its verbs. A view: the program's CommandLine owns it.
class Verb {
 public:
  explicit Verb(CLI::App* app) : app_(app) {}

  // A verb has the footer that this one has now until it is given its own.
  Verb add_subcommand(const std::string& name, const std::string& about);
  // At least one of the subcommands has to follow.
  void require_subcommand();
  void footer(const std::string& text);
  // "-o,--out": an option; "DIR": a positional. The variable, set while the line is parsed, holds
  // the default. Lists take one value or more. Without an `about` it works and is not in the help.
  Option add_option(const std::string& names, std::string& value, const std::string& about);
  Option add_option(const std::string& names, int& value, const std::string& about);
  Option add_option(const std::string& names, std::optional<int>& value, const std::string& about);
  Option add_option(const std::string& names, std::optional<std::uint32_t>& value,
                    const std::string& about);
  Option add_option(const std::string& names, double& value, const std::string& about);
  Option add_option(const std::string& names, std::vector<std::string>& value,
                    const std::string& about);
  Option add_flag(const std::string& names, bool& value, const std::string& about);
  // `given` runs before the callback of any verb.
  Option add_flag(const std::string& names, std::function<void()> given, const std::string& about);
  // An option that is given with an empty text, as a shell does with an unset variable, is refused:
  // it must not mean the default. For the options that were added before.
  void refuse_empty_values();
  // With all verbs below, as they were added so far.
  VerbText text() const;
  // Runs when the whole line was understood.
  void callback(std::function<void()> run);

 private:
  CLI::App* app_;
};

// What parsing came to, besides the callback that ran.
struct ParsedLine {
  bool finished = false;  // --help, --version or an error that was printed; leave with `exit`
  int exit = 0;
  bool has_verb = false;
};

class CommandLine {
 public:
  CommandLine(const std::string& about, const std::string& footer, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // Options that it has may stand behind a verb, too.
  Verb program();
  // Names of the verbs, in the order in which they were added.
  std::vector<std::string> verbs() const;
  std::string help() const;
  // Parses and runs the callback of the verb. What callbacks throw passes through.
  ParsedLine parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace probe::cli

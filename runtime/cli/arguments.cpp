#include "runtime/cli/arguments.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <span>

#include "compiler/diag/diagnostic.h"
#include "runtime/base/say.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {
namespace {

// CLI11 says "was not expected" for an unknown word; people want to know which word was meant.
int report_unknown(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words) {
  const CLI::App* verb = &app;
  for (const CLI::App* chosen : app.get_subcommands()) verb = chosen;
  std::vector<std::string> names;
  for (const CLI::App* of : {verb, &app}) {  // the program's stand behind a verb, too
    for (const CLI::Option* option : of->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  say("vlaprobe: {}\n", error.what());
  for (const char* word : words) {
    const std::string flag(word, std::strcspn(word, "="));
    if (flag.rfind("--", 0) != 0 || std::find(known.begin(), known.end(), flag) != known.end())
      continue;
    const auto close = nearest(flag, known);
    if (close) say("  did you mean `{}`?\n", *close);
  }
  say("  `vlaprobe {}--help` lists what it takes\n", verb == &app ? "" : verb->get_name() + " ");
  return kUser;
}

// CLI11 says of a choice "{a,b}" and of nothing else with braces.
std::vector<std::string> choices(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.rfind('{'), close = type.rfind('}');
  std::vector<std::string> words;
  if (open == std::string::npos || close == std::string::npos || close < open) return words;
  for (std::size_t at = open + 1; at < close;) {
    const std::size_t end = std::min(type.find(',', at), close);
    words.push_back(type.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

VerbText text_of(const CLI::App& app) {
  VerbText text{.name = app.get_name(), .about = app.get_description(), .footer = app.get_footer(), .options = {}, .verbs = {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_description().empty()) continue;
    OptionText& said = text.options.emplace_back();
    said.is_positional = !option->nonpositional();
    if (said.is_positional) said.names = {option->get_name()};
    for (const std::string& name : option->get_snames()) said.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) said.names.push_back("--" + name);
    said.about = option->get_description();
    said.takes_value = option->get_expected_max() > 0;
    said.values = choices(*option);
  }
  for (const CLI::App* verb : app.get_subcommands({})) text.verbs.push_back(text_of(*verb));
  return text;
}

// The help has what something is said of.
class SaidFormatter final : public CLI::Formatter {
 public:
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    std::erase_if(options,
                  [](const CLI::Option* option) { return option->get_description().empty(); });
    if (options.empty()) return "";
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }
};

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::delimiter(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::one_each() {
  option_->expected(1)->take_all();
  return *this;
}

Option& Option::no_extra_values() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::between(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  option_->check(CLI::IsMember(std::move(words)));
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Verb Verb::add_subcommand(const std::string& name, const std::string& about) {
  return Verb(app_->add_subcommand(name, about));
}

void Verb::require_subcommand() { app_->require_subcommand(1); }

void Verb::footer(const std::string& text) { app_->footer(text); }

Option Verb::add_option(const std::string& names, std::string& value, const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_option(const std::string& names, int& value, const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_option(const std::string& names, std::optional<int>& value,
                        const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_option(const std::string& names, std::optional<std::uint32_t>& value,
                        const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_option(const std::string& names, double& value, const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_option(const std::string& names, std::vector<std::string>& value,
                        const std::string& about) {
  return Option(app_->add_option(names, value, about));
}

Option Verb::add_flag(const std::string& names, bool& value, const std::string& about) {
  return Option(app_->add_flag(names, value, about));
}

Option Verb::add_flag(const std::string& names, std::function<void()> given,
                      const std::string& about) {
  return Option(app_->add_flag_callback(names, std::move(given), about));
}

void Verb::refuse_empty_values() {
  for (CLI::Option* option : app_->get_options()) {
    if (option->get_expected_max() == 0) continue;
    option->check([](const std::string& value) {
      return value.empty() ? std::string("is empty") : std::string();
    });
  }
}

VerbText Verb::text() const { return text_of(*app_); }

void Verb::callback(std::function<void()> run) { app_->callback(std::move(run)); }

CommandLine::CommandLine(const std::string& about, const std::string& footer,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(about)) {
  app_->footer(footer);
  app_->require_subcommand(0, 1);
  app_->fallthrough();  // as its verbs then do
  app_->set_version_flag("--version", version);
  app_->formatter(std::make_shared<SaidFormatter>());  // verbs have that of the program
  app_->get_formatter()->column_width(28);
}

CommandLine::~CommandLine() = default;

Verb CommandLine::program() { return Verb(app_.get()); }

std::vector<std::string> CommandLine::verbs() const {
  std::vector<std::string> names;
  for (const CLI::App* verb : app_->get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

std::string CommandLine::help() const { return app_->help(); }

ParsedLine CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return {.finished = true, .exit = app_->exit(success)};
  } catch (const CLI::ParseError& error) {
    const std::span words(argv + 1, static_cast<std::size_t>(argc - 1));
    return {.finished = true, .exit = report_unknown(*app_, error, words)};
  }
  return {.has_verb = !app_->get_subcommands().empty()};
}

}  // namespace probe::cli

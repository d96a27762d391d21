#include "runtime/cli/manual_text.h"

#include <fmt/format.h>

namespace probe::cli {
namespace {

// As text of roff: no hyphenation marks, escapes or requests of its own.
std::string plain(std::string_view text) {
  std::string out;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    begins_line = c == '\n';
  }
  return out;
}

std::string options_of(const VerbText& verb) {
  std::string out;
  for (const OptionText& option : verb.options) {
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + name;
    std::string values;
    for (const std::string& value : option.values) values += (values.empty() ? "" : "|") + value;
    if (!values.empty()) {
      names += " " + values;
    } else if (option.takes_value && !option.is_positional) {
      names += " VALUE";
    }
    out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", plain(names), plain(option.about));
  }
  return out;
}

void add_verb(const VerbText& verb, const std::string& path, std::string& out) {
  out += fmt::format(".SS \"vlaprobe {}\"\n{}.\n", plain(path), plain(verb.about));
  out += options_of(verb);
  if (!verb.footer.empty()) out += fmt::format(".PP\n.nf\n{}\n.fi\n", plain(verb.footer));
  for (const VerbText& below : verb.verbs) add_verb(below, path + " " + below.name, out);
}

}  // namespace

std::string manual_page(const VerbText& program, const std::string& version) {
  std::string out = fmt::format(
      ".TH VLAPROBE 1 \"\" \"vlaprobe {}\"\n.SH NAME\nvlaprobe \\- {}\n.SH SYNOPSIS\n"
      ".B vlaprobe\n.I VERB\n[\\fIarguments\\fR]\n.SH VERBS\n",
      plain(version), plain(program.about.substr(program.about.find(": ") + 2)));
  for (const VerbText& verb : program.verbs) add_verb(verb, verb.name, out);
  out += fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", plain(program.footer));
  return out;
}

std::string verb_table(const VerbText& program) {
  std::string out = "| verb | what it does |\n|---|---|\n";
  const auto add = [&](const VerbText& verb, const std::string& path) {
    std::string about;
    for (const char c : verb.about) about += c == '|' ? std::string("\\|") : std::string(1, c);
    out += fmt::format("| `{}` | {} |\n", path, about);
  };
  for (const VerbText& verb : program.verbs) {
    add(verb, verb.name);
    for (const VerbText& below : verb.verbs) add(below, verb.name + " " + below.name);
  }
  return out;
}

}  // namespace probe::cli

#include "runtime/cli/completion_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/shell_word.h"

namespace probe::cli {
namespace {

// Of zsh's descriptions, in which brackets and colons have a meaning.
std::string zsh_words(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("[]:\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

// "run", "assets import" and what may follow each: verbs, options.
struct Place {
  std::string path;
  const VerbText* verb;
};

void collect(const VerbText& verb, const std::string& path, std::vector<Place>& places) {
  places.push_back({path, &verb});
  for (const VerbText& below : verb.verbs)
    collect(below, path.empty() ? below.name : path + " " + below.name, places);
}

std::vector<Place> places_of(const VerbText& program) {
  std::vector<Place> places;
  collect(program, "", places);
  return places;
}

}  // namespace

std::string bash_completion(const VerbText& program) {
  std::string words, values;
  for (const Place& place : places_of(program)) {
    std::vector<std::string> all;
    for (const VerbText& verb : place.verb->verbs) all.push_back(verb.name);
    for (const OptionText& option : place.verb->options) {
      if (option.is_positional) continue;
      all.insert(all.end(), option.names.begin(), option.names.end());
      for (const std::string& name : option.names) {
        if (!option.values.empty())
          values += fmt::format("    {}) words={} ;;\n", shell_word(place.path + " " + name), shell_word(joined(option.values)));
        else if (option.takes_value)
          values += fmt::format("    {}) return ;;\n", shell_word(place.path + " " + name));
      }
    }
    words += fmt::format("    {}) words={} ;;\n", shell_word(place.path), shell_word(joined(all)));
  }
  return fmt::format(R"(# source <(vlaprobe completion bash)
_vlaprobe() {{
  local at=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} path='' verbs words='' i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    verbs=$(_vlaprobe_words "$path")
    case " $verbs " in *" ${{COMP_WORDS[i]}} "*) [[ ${{COMP_WORDS[i]}} == -* ]] || path="${{path:+$path }}${{COMP_WORDS[i]}}" ;; esac
  done
  # What an option takes; files, where nothing is said of it.
  case "$path $before" in
{1}    *) for i in $(_vlaprobe_words "$path"); do
         case $at/$i in -*/-* | [!-]*/[!-]* | /[!-]*) words+=" $i" ;; esac
       done ;;
  esac
  [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$at")
}}
_vlaprobe_words() {{
  local words=''
  case $1 in
{0}  esac
  echo "$words"
}}
complete -o default -F _vlaprobe vlaprobe
)",
                     words, values);
}

std::string zsh_completion(const VerbText& program) {
  std::string functions;
  for (const Place& place : places_of(program)) {
    std::string name = "_vlaprobe" + (place.path.empty() ? "" : "_" + place.path);
    std::ranges::replace(name, ' ', '_');
    std::string arguments;
    for (const OptionText& option : place.verb->options) {
      std::string value;
      if (!option.values.empty())
        value = ":value:(" + joined(option.values) + ")";
      else if (option.takes_value)
        value = ":value:_files";
      if (option.is_positional) continue;  // files, below
      for (const std::string& word : option.names)
        arguments += fmt::format("    {} \\\n", shell_word(word + "[" + zsh_words(option.about) + "]" + value));
    }
    if (place.verb->verbs.empty()) {
      functions += fmt::format("{}() {{\n  _arguments \\\n{}    '*:file:_files' && return\n}}\n", name, arguments);
      continue;
    }
    std::string verbs, cases;
    for (const VerbText& verb : place.verb->verbs) {
      verbs += fmt::format("    {}\n", shell_word(zsh_words(verb.name) + ":" + zsh_words(verb.about)));
      cases += fmt::format("      {}) {}_{} ;;\n", verb.name, name, verb.name);
    }
    functions += fmt::format(R"({0}() {{
  local line state
  local -a verbs
  verbs=(
{1}  )
  _arguments -C \
    '1: :->verb' \
    '*::argument:->rest' && return
  case $state in
    verb) _describe verb verbs ;;
    rest)
      case $line[1] in
{2}      esac ;;
  esac
}}
)",
                             name, verbs, cases);
  }
  return "#compdef vlaprobe\n" + functions + "_vlaprobe \"$@\"\n";
}

std::string fish_completion(const VerbText& program) {
  std::string out = "complete -c vlaprobe -f -n __fish_use_subcommand\n";
  for (const Place& place : places_of(program)) {
    std::string here = "__fish_use_subcommand";
    for (std::size_t at = 0; at < place.path.size();) {
      const std::size_t end = std::min(place.path.find(' ', at), place.path.size());
      here = (at == 0 ? "" : here + "; and ") + "__fish_seen_subcommand_from " + place.path.substr(at, end - at);
      at = end + 1;
    }
    for (const VerbText& verb : place.verb->verbs)
      out += fmt::format("complete -c vlaprobe -n {} -a {} -d {}\n", shell_word(here), verb.name, shell_word(verb.about));
    for (const OptionText& option : place.verb->options) {
      if (option.is_positional) continue;
      std::string names;
      for (const std::string& name : option.names)
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      std::string value = option.takes_value ? " -r" : "";
      if (!option.values.empty()) value = " -x -a " + shell_word(joined(option.values));
      out += fmt::format("complete -c vlaprobe -n {}{}{} -d {}\n", shell_word(here), names, value, shell_word(option.about));
    }
  }
  return out;
}

}  // namespace probe::cli

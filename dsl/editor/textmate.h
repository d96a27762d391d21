// The TextMate grammar of .probe, made from the tables of words and units, so that editors and
// compiler cannot disagree about words. The file in vscode/syntaxes is this text; a test compares
// them.
#pragma once

#include <string>

namespace probe::editor {

std::string textmate_grammar();

}  // namespace probe::editor

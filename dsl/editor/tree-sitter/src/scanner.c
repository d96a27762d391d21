// Which line ends count. Knows brackets and lines; what may stand where is the business of
// grammar.js.
//
// A line end ends a statement, except inside parentheses; inside a block that stands within
// parentheses it counts again. grammar.js says behind which signs a line goes on; where nothing
// takes a line end, none is given, which is a mistake as it is for the compiler.
#include <stdlib.h>
#include <string.h>
#include <tree_sitter/parser.h>

// In the order of `externals` in grammar.js.
enum Token {
  NEWLINE,
  BLANK_LINE,
  OPEN_PAREN,
  CLOSE_PAREN,
  OPEN_BRACE,
  CLOSE_BRACE,
  SET_BEGIN,
  TEXT,
  CHARACTERS
};

// A word that begins a declaration at the first column ends what was not closed above it, so that a
// parenthesis that is missing while one types does not take the rest of the file with it. The words
// of compiler/syntax/keywords.def.
static const char* const DECLARATIONS[] = {
    "use",     "dataset",   "attribute", "facts",    "object", "extend",  "robot",
    "camera",  "light",     "fixture",   "scene",    "layout", "role",    "template",
    "metrics", "predicate", "relation",  "abstract", "task",   "variant", "variants",
    "derive",  "set",       "questions", "space", "suite",
};
enum { LONGEST_DECLARATION = 9 };

// The brackets that are open, outermost first: '(', '{', or '[' for the brace of names that stand
// within parentheses.
typedef struct {
  unsigned depth;  // may exceed what is kept: the compiler refuses 200 levels
  char open[TREE_SITTER_SERIALIZATION_BUFFER_SIZE - sizeof(unsigned)];
} Scanner;

void* tree_sitter_probe_external_scanner_create(void);
void tree_sitter_probe_external_scanner_destroy(void* payload);
unsigned tree_sitter_probe_external_scanner_serialize(void* payload, char* buffer);
void tree_sitter_probe_external_scanner_deserialize(void* payload, const char* buffer,
                                                    unsigned length);
bool tree_sitter_probe_external_scanner_scan(void* payload, TSLexer* lexer, const bool* valid);

static bool in_parens(const Scanner* scanner) {
  return scanner->depth > 0 && scanner->depth <= sizeof scanner->open &&
         scanner->open[scanner->depth - 1] != '{';
}

static bool push(Scanner* scanner, char bracket) {
  if (scanner->depth < sizeof scanner->open) scanner->open[scanner->depth] = bracket;
  ++scanner->depth;
  return true;
}

// Closes the innermost parenthesis or brace, and parentheses that were left open inside of the
// brace; nothing if there is none. A parenthesis does not close what stands around its braces.
static bool pop(Scanner* scanner, bool paren) {
  for (unsigned depth = scanner->depth; depth > 0; --depth) {
    const bool known = depth <= sizeof scanner->open;
    if (!known || (scanner->open[depth - 1] == '(') == paren) {
      scanner->depth = depth - 1;
      break;
    }
    if (paren) break;
  }
  return true;
}

static bool is_letter(int32_t c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static bool is_word(int32_t c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

// Reads the word that begins here.
static bool at_declaration(TSLexer* lexer) {
  char word[LONGEST_DECLARATION + 1];
  unsigned size = 0;
  if (lexer->lookahead == '@') return true;
  for (; is_word(lexer->lookahead); lexer->advance(lexer, false)) {
    if (size == LONGEST_DECLARATION) return false;
    word[size++] = (char)lexer->lookahead;
  }
  word[size] = '\0';
  for (unsigned i = 0; i < sizeof DECLARATIONS / sizeof *DECLARATIONS; ++i) {
    if (strcmp(word, DECLARATIONS[i]) == 0) return true;
  }
  return false;
}

static bool newline(Scanner* scanner, TSLexer* lexer, const bool* valid) {
  bool at_margin = false;
  while (lexer->lookahead == ' ' || lexer->lookahead == '\t' || lexer->lookahead == '\r' ||
         lexer->lookahead == '\n') {
    at_margin = lexer->lookahead == '\n';
    lexer->advance(lexer, false);
    if (at_margin) lexer->mark_end(lexer);
  }
  if (in_parens(scanner)) {
    if (!at_margin || !at_declaration(lexer)) {
      lexer->result_symbol = BLANK_LINE;
      return valid[BLANK_LINE];
    }
    scanner->depth = 0;
  }
  lexer->result_symbol = NEWLINE;
  return valid[NEWLINE];
}

// Takes the bracket, where a rule does.
static bool bracket(TSLexer* lexer, const bool* valid, enum Token token) {
  if (!valid[token]) return false;
  lexer->advance(lexer, false);
  lexer->mark_end(lexer);
  lexer->result_symbol = token;
  return true;
}

// Of a string, which stands on one line. Braces in templates are slots.
static bool text(TSLexer* lexer, bool has_slots) {
  bool any = false;
  while (!lexer->eof(lexer)) {
    const int32_t c = lexer->lookahead;
    if (c == '"' || c == '\\' || c == '\n' || (has_slots && (c == '{' || c == '}'))) break;
    lexer->advance(lexer, false);
    any = true;
  }
  lexer->result_symbol = has_slots ? TEXT : CHARACTERS;
  return any;
}

void* tree_sitter_probe_external_scanner_create(void) { return calloc(1, sizeof(Scanner)); }

void tree_sitter_probe_external_scanner_destroy(void* payload) { free(payload); }

unsigned tree_sitter_probe_external_scanner_serialize(void* payload, char* buffer) {
  const Scanner* scanner = payload;
  const unsigned kept =
      scanner->depth < sizeof scanner->open ? scanner->depth : sizeof scanner->open;
  if (scanner->depth == 0) return 0;
  memcpy(buffer, &scanner->depth, sizeof scanner->depth);
  memcpy(buffer + sizeof scanner->depth, scanner->open, kept);
  return sizeof scanner->depth + kept;
}

void tree_sitter_probe_external_scanner_deserialize(void* payload, const char* buffer,
                                                    unsigned length) {
  Scanner* scanner = payload;
  scanner->depth = 0;
  if (length < sizeof scanner->depth) return;
  memcpy(&scanner->depth, buffer, sizeof scanner->depth);
  memcpy(scanner->open, buffer + sizeof scanner->depth, length - sizeof scanner->depth);
}

bool tree_sitter_probe_external_scanner_scan(void* payload, TSLexer* lexer, const bool* valid) {
  Scanner* scanner = payload;
  // While tree-sitter looks for where to go on after a mistake, everything is valid; in a string
  // one of them is.
  if (valid[TEXT] != valid[CHARACTERS]) return text(lexer, valid[TEXT]);
  while (lexer->lookahead == ' ' || lexer->lookahead == '\t' || lexer->lookahead == '\r')
    lexer->advance(lexer, true);
  switch (lexer->lookahead) {
    case '\n':
      return newline(scanner, lexer, valid);
    case '(':
      return bracket(lexer, valid, OPEN_PAREN) && push(scanner, '(');
    case '{':
      if (bracket(lexer, valid, OPEN_BRACE)) return push(scanner, '{');
      return bracket(lexer, valid, SET_BEGIN) && push(scanner, in_parens(scanner) ? '[' : '{');
    case ')':
      return bracket(lexer, valid, CLOSE_PAREN) && pop(scanner, true);
    case '}':
      return bracket(lexer, valid, CLOSE_BRACE) && pop(scanner, false);
    default:
      return false;
  }
}

-- Neovim's own tree-sitter with our grammar: a file is parsed, coloured and folded, and follows what is typed.
-- Says a line for each on $VLAPROBE_TOLD.
local told = io.open(vim.env.VLAPROBE_TOLD, 'w')
local function say(what, text)
  told:write(what .. ': ' .. tostring(text) .. '\n')
  told:flush()
end

vim.opt.runtimepath:prepend(vim.env.VLAPROBE_RUNTIME)
vim.cmd('edit ' .. vim.env.VLAPROBE_FILE)
local parser = vim.treesitter.get_parser(0, 'probe')
local function root() return parser:parse()[1]:root() end
say('root', root():type())
say('mistakes', root():has_error())

local function count(file, wanted)
  local query = vim.treesitter.get_query('probe', file)
  local found = 0
  for id in query:iter_captures(root(), 0) do
    if query.captures[id] == wanted then found = found + 1 end
  end
  return found
end
say('types', count('highlights', 'type'))
say('folds', count('folds', 'fold'))

-- A task at the end, letter by letter, and a parenthesis that is missing for a while.
local last = vim.api.nvim_buf_line_count(0)
local line = 'task more like a { distractors 2 of (b, c) seed 1 }'
vim.api.nvim_buf_set_lines(0, last, last, false, { '' })
for i = 1, #line do
  vim.api.nvim_buf_set_text(0, last, i - 1, last, i - 1, { line:sub(i, i) })
  root()
end
say('typed', root():has_error())
vim.api.nvim_buf_set_text(0, last, line:find('%)') - 1, last, line:find('%)'), { '' })
say('without )', root():has_error())

-- What the editor itself does with the colours.
vim.treesitter.highlighter.new(parser)
vim.cmd('redraw!')
say('shown', 'yes')
vim.cmd('qall!')

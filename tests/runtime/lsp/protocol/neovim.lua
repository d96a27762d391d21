-- Neovim as an author uses it: every request that its client can make. Says a line for each on
-- $VLAPROBE_TOLD; messages go through `tee` so that they can be held to the protocol.
local folder, told = vim.env.VLAPROBE_FOLDER, io.open(vim.env.VLAPROBE_TOLD, 'w')
local function say(what, text)
  told:write(what .. ': ' .. tostring(text):gsub('\n', ' | ') .. '\n')
  told:flush()
end
local function wait(what, fits)
  if not vim.wait(20000, fits, 20) then say(what, 'NOTHING CAME') end
end

-- What the client got, before it does with it what it does.
local got = {}
for method, handler in pairs(vim.lsp.handlers) do
  vim.lsp.handlers[method] = function(err, result, ctx, config)
    got[method] = { err = err, result = result }
    return handler(err, result, ctx, config)
  end
end
local function ask(what, method, act)
  got[method] = nil
  local fine, mistake = pcall(act)
  if not fine then return say(what, 'FAILED ' .. mistake) end
  wait(what, function() return got[method] ~= nil end)
  local answer = got[method]
  if answer and answer.err then say(what, 'ERROR ' .. vim.inspect(answer.err)) end
  return answer and answer.result
end

vim.o.hidden = true
vim.cmd('autocmd BufNewFile,BufRead *.probe setfiletype probe')
local id = vim.lsp.start_client({
  name = 'vlaprobe',
  cmd = { 'sh', '-c', 'tee "$VLAPROBE_FROM_EDITOR" | "$VLAPROBE_PROGRAM" lsp | tee "$VLAPROBE_FROM_SERVER"' },
  root_dir = folder,
})
vim.cmd('edit ' .. folder .. '/user.probe')
vim.lsp.buf_attach_client(0, id)
wait('start', function() return vim.lsp.buf.server_ready() end)
local function go(word)
  vim.fn.cursor(1, 1)
  vim.fn.search(word, 'cW')
end
local function codes()
  local out = {}
  for _, item in ipairs(vim.diagnostic.get(0)) do table.insert(out, item.code) end
  table.sort(out)
  return table.concat(out, ' ')
end

wait('diagnostics', function() return codes():find('P0201') end)
say('diagnostics', codes())

-- A fix, as the list of actions offers it.
go('bal ')
vim.ui.select = function(items, _, choose) choose(items[1], 1) end
ask('code action', 'textDocument/publishDiagnostics', function() vim.lsp.buf.code_action() end)
wait('code action', function() return vim.fn.getline(2):find('like ball ') end)
say('code action', vim.fn.getline(2))
wait('mended', function() return not codes():find('P0201') end)
say('mended', codes():find('P0201') and 'no' or 'yes')

go('ball')
say('hover', ask('hover', 'textDocument/hover', vim.lsp.buf.hover).contents.value)
go('ball')
say('highlight', #ask('highlight', 'textDocument/documentHighlight', vim.lsp.buf.document_highlight))
say('references', #ask('references', 'textDocument/references', vim.lsp.buf.references))
vim.cmd('cclose')
say('symbols', #ask('symbols', 'textDocument/documentSymbol', vim.lsp.buf.document_symbol))
vim.cmd('cclose')
say('workspace symbols', #ask('workspace symbols', 'workspace/symbol', function() vim.lsp.buf.workspace_symbol('ball') end))
vim.cmd('cclose')

go('distance(')
vim.fn.search('(', 'cW')
vim.fn.cursor(0, vim.fn.col('.') + 1)
say('signature', ask('signature', 'textDocument/signatureHelp', vim.lsp.buf.signature_help).signatures[1].label)

-- Completion through 'omnifunc', as Ctrl-X Ctrl-O does.
vim.fn.append('$', 'object third like b')
vim.fn.cursor(vim.fn.line('$'), 99)
local answers = vim.lsp.buf_request_sync(0, 'textDocument/completion', vim.lsp.util.make_position_params(), 20000)
local labels = {}
for _, answer in pairs(answers or {}) do
  for _, item in ipairs(vim.lsp.util.extract_completion_items(answer.result)) do table.insert(labels, item.label) end
end
table.sort(labels)
say('completion', table.concat(labels, ' '))
vim.cmd('normal! Gdd')

vim.lsp.codelens.refresh()
wait('lenses', function() return #vim.lsp.codelens.get(0) > 0 end)
for _, lens in ipairs(vim.lsp.codelens.get(0)) do say('lens', lens.command.title .. ' ' .. lens.command.command) end

-- Requests of which this version has no command of its own: its client sends them, too.
local function send(method, params, told)
  params.textDocument = vim.lsp.util.make_text_document_params()
  local all = vim.lsp.buf_request_sync(0, 'textDocument/' .. method, params, 20000)
  for _, answer in pairs(all or {}) do say(method, answer.result and told(answer.result) or vim.inspect(answer)) end
end
local function count(result) return #result end
send('foldingRange', {}, count)
send('documentLink', {}, count)
send('semanticTokens/full', {}, function(result) return #result.data / 5 end)
local whole = { start = { line = 0, character = 0 }, ['end'] = { line = 9, character = 0 } }
send('semanticTokens/range', { range = whole }, function(result) return #result.data / 5 end)
send('inlayHint', { range = whole }, count)
send('diagnostic', {}, function(result) return result.kind .. ' ' .. #result.items end)
go('ball')
send('prepareRename', { position = vim.lsp.util.make_position_params().position }, function(result) return result.placeholder end)

go('ball')
ask('definition', 'textDocument/definition', vim.lsp.buf.definition)
wait('definition', function() return vim.fn.expand('%:t') == 'things.probe' end)
say('definition', vim.fn.expand('%:t') .. ' ' .. vim.fn.line('.') .. ' ' .. vim.fn.getline('.'))
vim.cmd('buffer user.probe')

go('ball')
ask('rename', 'textDocument/rename', function() vim.lsp.buf.rename('globe') end)
wait('rename', function() return vim.fn.getline(2):find('like globe') end)
say('rename', vim.fn.getline(2))

vim.fn.setline(2, '  ' .. vim.fn.getline(2))
vim.lsp.buf.formatting_sync(nil, 20000)
say('formatting', vim.fn.getline(2))

-- The first `tee` ends only when it is told something more.
vim.lsp.get_client_by_id(id).stop()
vim.wait(1000, function() return vim.lsp.client_is_stopped(id) end)
say('end', 'done')
told:close()
vim.cmd('qa!')

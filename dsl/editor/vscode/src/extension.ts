// Starts `vlaprobe lsp` for texts in Probe, and runs what its lenses name in a terminal.
import * as path from 'node:path';
import * as vscode from 'vscode';
import { LanguageClient } from 'vscode-languageclient/node';
import { linesFor, quoted } from './commands';

let client: LanguageClient | undefined;

function setting(name: string): string {
  return vscode.workspace.getConfiguration('vlaprobe').get<string>(name, '');
}

// One folder or several, as words of the program.
function assets(): string[] {
  const given = vscode.workspace.getConfiguration('vlaprobe').get<string | string[]>('assets', '');
  return [given].flat().filter((folder) => folder).flatMap((folder) => ['--assets', folder]);
}

async function start(): Promise<void> {
  client = new LanguageClient(
    'vlaprobe',
    'Probe',
    { command: setting('program') || 'vlaprobe', args: ['lsp', ...assets()] },
    { documentSelector: [{ language: 'probe' }] },
  );
  try {
    await client.start();
  } catch (mistake) {
    const said = await vscode.window.showErrorMessage(
      `vlaprobe could not be started (${String(mistake)}): set "vlaprobe.program" to its path.`,
      'Settings',
    );
    if (said) await vscode.commands.executeCommand('workbench.action.openSettings', 'vlaprobe.program');
  }
}

async function restart(): Promise<void> {
  await client?.stop().catch(() => undefined);
  await start();
}

function run(command: string, uri: string, subject: string): void {
  const file = vscode.Uri.parse(uri).fsPath;
  const folder = path.dirname(file);
  const terminal =
    vscode.window.terminals.find((known) => known.name === 'vlaprobe') ??
    vscode.window.createTerminal({ name: 'vlaprobe', cwd: folder });
  terminal.show(true);
  const more = assets().map((word) => ` ${quoted(word)}`).join('');
  for (const line of linesFor(command, setting('program') || 'vlaprobe', file, subject, more))
    terminal.sendText(line);
}

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  for (const command of ['vlaprobe.show', 'vlaprobe.preview', 'vlaprobe.runExpert', 'vlaprobe.list']) {
    context.subscriptions.push(
      vscode.commands.registerCommand(command, async (uri: string, subject: string) => {
        // The program reads the disk.
        await vscode.workspace.saveAll(false);
        run(command, uri, subject);
      }),
    );
  }
  context.subscriptions.push(
    vscode.commands.registerCommand('vlaprobe.restart', restart),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration('vlaprobe')) void restart();
    }),
  );
  await start();
}

export async function deactivate(): Promise<void> {
  await client?.stop();
}

// What a lens runs, as lines of a shell. Knows nothing of the editor.

// One word for a POSIX shell, fish and PowerShell alike where it has nothing special; else in quotes.
export function quoted(word: string): string {
  if (/^[\w@%+=:,.\/\\-]+$/.test(word)) return word;
  return process.platform === 'win32' ? `'${word.replaceAll("'", "''")}'` : `'${word.replaceAll("'", `'\\''`)}'`;
}

// `subject` is a task; of `vlaprobe.list` a suite. `more`: options of every command.
export function linesFor(command: string, program: string, file: string, subject: string, more = ''): string[] {
  const say = (verb: string, ...words: string[]) =>
    [quoted(program), verb, ...words.map(quoted)].join(' ') + more;
  switch (command) {
    case 'vlaprobe.show':
      return [say('show', file, subject)];
    case 'vlaprobe.preview':
      return [say('preview', file, subject, '-o', `${subject}.png`)];
    case 'vlaprobe.runExpert':
      return [
        say('run', file, '--tasks', subject, '--policy', 'expert', '-o', `runs/${subject}`),
        say('results', `runs/${subject}`).slice(0, more ? -more.length : undefined),
      ];
    case 'vlaprobe.list':
      return [say('list', file, '--suite', subject)];
  }
  return [];
}

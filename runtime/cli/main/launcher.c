/* What is called in a bundle: `bin/vlaprobe` starts `programs/vlaprobe` by the loader and with the libraries that lie in
   `lib`, so that nothing depends on the system's. Linked statically, for the oldest CPU of its kind, so that it can say
   what is missing instead of dying of an instruction. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { kNotStarted = 2 }; /* exit code: files, network or policy */

static int fail(const char* what, const char* where) {
  fprintf(stderr, "vlaprobe: %s: %s\n", what, where);
  return kNotStarted;
}

int main(int argc, char** argv) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports(VLAPROBE_MARCH)) {
    return fail("this CPU has not the instructions that the bundle was made for",
                VLAPROBE_MARCH "; build it here with -DVLAPROBE_MARCH=x86-64");
  }
#endif
  char self[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
  if (length <= 0) return fail("cannot read", "/proc/self/exe");
  self[length] = '\0';
  char* name = strrchr(self, '/') + 1; /* the file, whatever link it was called by */
  char program[PATH_MAX], loader[PATH_MAX], libraries[PATH_MAX];
  const int folder = (int)(name - 1 - self);
  const int bin = (int)strlen("/bin");
  if (folder < bin || strncmp(self + folder - bin, "/bin", (size_t)bin) != 0) {
    return fail("is to lie in the folder `bin` of its bundle; make a link to it elsewhere", self);
  }
  const int root = folder - bin;
  if (snprintf(program, sizeof program, "%.*s/programs/%s", root, self, name) >= PATH_MAX ||
      snprintf(loader, sizeof loader, "%.*s/lib/" VLAPROBE_LOADER, root, self) >= PATH_MAX ||
      snprintf(libraries, sizeof libraries, "%.*s/lib", root, self) >= PATH_MAX) {
    return fail("has too long a path", self);
  }
  if (strpbrk(libraries, ":;") != NULL) {
    return fail("no library is found below a folder with `:` or `;` in its name", libraries);
  }
  char** words = calloc((size_t)argc + 6, sizeof *words);
  if (words == NULL) return fail("no memory", self);
  char** word = words;
  *word++ = loader;
  *word++ = "--inhibit-cache";
  *word++ = "--library-path";
  *word++ = libraries;
  *word++ = program;
  for (int i = 1; i < argc; ++i) *word++ = argv[i];
  execv(loader, words);
  return fail(strerror(errno), loader);
}

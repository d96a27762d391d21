/* unzstd: standard input, compressed by zstd, to standard output. install.sh carries it for systems without zstd. */
#include <stdio.h>
#include <stdlib.h>
#include <zstd.h>

int main(void) {
  const size_t in_size = ZSTD_DStreamInSize(), out_size = ZSTD_DStreamOutSize();
  ZSTD_DStream* stream = ZSTD_createDStream();
  char* in = malloc(in_size);
  char* out = malloc(out_size);
  if (stream == NULL || in == NULL || out == NULL) return 2;
  size_t left = 1; /* 0 at the end of a frame */
  for (size_t got; (got = fread(in, 1, in_size, stdin)) > 0;) {
    ZSTD_inBuffer input = {in, got, 0};
    while (input.pos < input.size) {
      ZSTD_outBuffer output = {out, out_size, 0};
      left = ZSTD_decompressStream(stream, &output, &input);
      if (ZSTD_isError(left)) {
        fprintf(stderr, "unzstd: %s\n", ZSTD_getErrorName(left));
        return 2;
      }
      if (fwrite(out, 1, output.pos, stdout) != output.pos) {
        perror("unzstd");
        return 2;
      }
    }
  }
  if (left != 0) fprintf(stderr, "unzstd: the file ends too soon\n");
  return left != 0 || fflush(stdout) != 0 ? 2 : 0;
}

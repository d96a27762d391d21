// libx264 through libavcodec, one thread, constant quality; the mp4 muxer in bit-exact mode with
// its index in front.
#include "runtime/show/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "runtime/show/yuv_frame.h"

namespace probe::show {
namespace {

class Mp4Writer final : public VideoWriter {
 public:
  explicit Mp4Writer(std::string path) : path_(std::move(path)) {}
  ~Mp4Writer() override {
    av_packet_free(&packet_);
    avcodec_free_context(&codec_);
    if (format_ != nullptr && format_->pb != nullptr) avio_closep(&format_->pb);
    avformat_free_context(format_);
  }

  Status begin(int width, int height, int frames_per_second) {
    if (width <= 0 || height <= 0 || width % 2 != 0 || height % 2 != 0) {
      return failed("a video has even sides", 0);
    }
    int code = avformat_alloc_output_context2(&format_, nullptr, "mp4", path_.c_str());
    if (code < 0) return failed("no mp4 muxer", code);
    format_->flags |= AVFMT_FLAG_BITEXACT;
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (encoder == nullptr) return failed("libavcodec has no libx264", 0);
    codec_ = avcodec_alloc_context3(encoder);
    packet_ = av_packet_alloc();
    stream_ = avformat_new_stream(format_, nullptr);
    if (codec_ == nullptr || packet_ == nullptr || stream_ == nullptr) {
      return failed("no memory", 0);
    }
    codec_->width = width;
    codec_->height = height;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = {1, frames_per_second};
    codec_->framerate = {frames_per_second, 1};
    codec_->thread_count = 1;
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
    av_opt_set(codec_->priv_data, "preset", "veryfast", 0);
    av_opt_set(codec_->priv_data, "crf", "20", 0);
    // x264's own threads would cut the picture by the number of cores; its macroblock tree, whose
    // AVX-512 code reads memory that nothing wrote, would make other bytes from the same pictures.
    av_opt_set(codec_->priv_data, "x264-params",
               "threads=1:lookahead-threads=1:sliced-threads=0:mbtree=0", 0);
    code = avcodec_open2(codec_, encoder, nullptr);
    if (code < 0) return failed("libx264 does not open", code);
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    code = avcodec_parameters_from_context(stream_->codecpar, codec_);
    if (code < 0) return failed("stream parameters", code);

    PROBE_TRY(picture_.begin(width, height, path_));

    code = avio_open(&format_->pb, path_.c_str(), AVIO_FLAG_WRITE);
    if (code < 0) return failed("cannot be made", code);
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "faststart", 0);
    code = avformat_write_header(format_, &options);
    av_dict_free(&options);
    if (code < 0) return failed("cannot be written", code);
    return {};
  }

  Status add(std::span<const std::uint8_t> rgb) override {
    PROBE_TRY(picture_.fill(rgb));
    return encode(picture_.frame());
  }

  Status finish() override {
    PROBE_TRY(encode(nullptr));
    int code = av_write_trailer(format_);
    if (code < 0) return failed("cannot be written", code);
    code = avio_closep(&format_->pb);
    if (code < 0) return failed("cannot be written", code);
    return {};
  }

 private:
  Failure failed(const char* what, int code) const { return av_failure(what, code, path_); }

  Status encode(const AVFrame* frame) {
    int code = avcodec_send_frame(codec_, frame);
    if (code < 0) return failed("cannot be encoded", code);
    for (;;) {
      code = avcodec_receive_packet(codec_, packet_);
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
      if (code < 0) return failed("cannot be encoded", code);
      packet_->duration = 1;
      packet_->stream_index = stream_->index;
      av_packet_rescale_ts(packet_, codec_->time_base, stream_->time_base);
      code = av_interleaved_write_frame(format_, packet_);
      if (code < 0) return failed("cannot be written", code);
    }
  }

  std::string path_;
  AVFormatContext* format_ = nullptr;
  AVCodecContext* codec_ = nullptr;
  AVStream* stream_ = nullptr;
  AVPacket* packet_ = nullptr;
  YuvFrame picture_;
};

}  // namespace

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const std::string& path, int width,
                                                         int height, int frames_per_second) {
  av_log_set_level(AV_LOG_ERROR);  // x264 tells its settings on stderr otherwise
  auto writer = std::make_unique<Mp4Writer>(path);
  PROBE_TRY(writer->begin(width, height, frames_per_second));
  return std::unique_ptr<VideoWriter>(std::move(writer));
}

}  // namespace probe::show

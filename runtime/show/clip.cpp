// libx264 for each clip, and one mp4 muxer in bit-exact mode, its index in front, for all of them.
// Without frames that look ahead every clip's packets are shown in the order in which they are
// stored, so joining is counting on.
#include "runtime/show/clip.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/base/apart.h"
#include "runtime/base/bytes.h"
#include "runtime/show/yuv_frame.h"

namespace probe::show {
namespace {

class X264Clip final : public ClipEncoder {
 public:
  explicit X264Clip(const ClipFormat& format) { clip_.format = format; }
  ~X264Clip() override {
    av_packet_free(&packet_);
    avcodec_free_context(&codec_);
  }

  Status begin() {
    const ClipFormat& format = clip_.format;
    if (format.width <= 0 || format.height <= 0 || format.width % 2 != 0 || format.height % 2 != 0)
      return failed("a video has even sides", 0);
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (encoder == nullptr) return failed("libavcodec has no libx264", 0);
    codec_ = avcodec_alloc_context3(encoder);
    packet_ = av_packet_alloc();
    if (codec_ == nullptr || packet_ == nullptr) return failed("no memory", 0);
    codec_->width = format.width;
    codec_->height = format.height;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = {1, format.frames_per_second};
    codec_->framerate = {format.frames_per_second, 1};
    codec_->gop_size = format.group;
    codec_->max_b_frames = 0;
    codec_->thread_count = 1;
    codec_->flags |= static_cast<int>(AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT |
                                      AV_CODEC_FLAG_CLOSED_GOP);
    av_opt_set(codec_->priv_data, "preset", "veryfast", 0);
    av_opt_set(codec_->priv_data, "crf", std::to_string(format.quality).c_str(), 0);
    // As in video.cpp, and nothing that waits for later frames.
    av_opt_set(codec_->priv_data, "x264-params",
               "threads=1:lookahead-threads=1:sliced-threads=0:mbtree=0:rc-lookahead=0:"
               "sync-lookahead=0:bframes=0:scenecut=0",
               0);
    int code = avcodec_open2(codec_, encoder, nullptr);
    if (code < 0) return failed("libx264 does not open", code);
    clip_.header.assign(codec_->extradata, codec_->extradata + codec_->extradata_size);
    return picture_.begin(format.width, format.height, "");
  }

  Status add(std::span<const std::uint8_t> rgb) override {
    PROBE_TRY(picture_.fill(rgb));
    return encode(picture_.frame());
  }

  Result<Clip> finish() override {
    PROBE_TRY(encode(nullptr));
    if (clip_.packets.size() != static_cast<std::size_t>(picture_.count()))
      return failed("the encoder gave another number of frames than it got", 0);
    return std::move(clip_);
  }

 private:
  Failure failed(const std::string& what, int code) const { return av_failure(what, code, ""); }

  Status encode(const AVFrame* frame) {
    int code = avcodec_send_frame(codec_, frame);
    if (code < 0) return failed("cannot be encoded", code);
    for (;;) {
      code = avcodec_receive_packet(codec_, packet_);
      if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
      if (code < 0) return failed("cannot be encoded", code);
      if (packet_->pts != packet_->dts) return failed("the encoder reorders frames", 0);
      clip_.packets.push_back({{packet_->data, packet_->data + packet_->size},
                               (packet_->flags & AV_PKT_FLAG_KEY) != 0});
      av_packet_unref(packet_);
    }
  }

  Clip clip_;
  AVCodecContext* codec_ = nullptr;
  AVPacket* packet_ = nullptr;
  YuvFrame picture_;
};

class Mp4Joiner final : public ClipJoiner {
 public:
  explicit Mp4Joiner(std::string path) : path_(std::move(path)) {}
  ~Mp4Joiner() override {
    av_packet_free(&packet_);
    if (format_ != nullptr && format_->pb != nullptr) avio_closep(&format_->pb);
    avformat_free_context(format_);
  }

  Status begin(const Clip& first) {
    clip_format_ = first.format;
    header_ = first.header;
    int code = avformat_alloc_output_context2(&format_, nullptr, "mp4", path_.c_str());
    if (code < 0) return failed("no mp4 muxer", code);
    format_->flags |= AVFMT_FLAG_BITEXACT;
    packet_ = av_packet_alloc();
    stream_ = avformat_new_stream(format_, nullptr);
    if (packet_ == nullptr || stream_ == nullptr) return failed("no memory", 0);
    AVCodecParameters& parameters = *stream_->codecpar;
    parameters.codec_type = AVMEDIA_TYPE_VIDEO;
    parameters.codec_id = AV_CODEC_ID_H264;
    parameters.format = AV_PIX_FMT_YUV420P;
    parameters.width = first.format.width;
    parameters.height = first.format.height;
    parameters.extradata =
        static_cast<std::uint8_t*>(av_mallocz(header_.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    if (parameters.extradata == nullptr) return failed("no memory", 0);
    std::memcpy(parameters.extradata, header_.data(), header_.size());
    parameters.extradata_size = static_cast<int>(header_.size());
    stream_->time_base = {1, first.format.frames_per_second};
    stream_->avg_frame_rate = {first.format.frames_per_second, 1};
    code = avio_open(&format_->pb, path_.c_str(), AVIO_FLAG_WRITE);
    if (code < 0) return failed("cannot be made", code);
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "faststart", 0);
    code = avformat_write_header(format_, &options);
    av_dict_free(&options);
    return code < 0 ? Status(failed("cannot be written", code)) : Status();
  }

  Status add(const Clip& clip) override {
    if (clip.format != clip_format_ || clip.header != header_)
      return failed("a clip of another format", 0);
    for (const Clip::Packet& clip_packet : clip.packets) {
      int code = av_new_packet(packet_, static_cast<int>(clip_packet.bytes.size()));
      if (code < 0) return failed("no memory", code);
      std::memcpy(packet_->data, clip_packet.bytes.data(), clip_packet.bytes.size());
      packet_->pts = packet_->dts = frames_++;
      packet_->duration = 1;
      packet_->stream_index = stream_->index;
      if (clip_packet.is_key) packet_->flags |= AV_PKT_FLAG_KEY;
      av_packet_rescale_ts(packet_, {1, clip_format_.frames_per_second}, stream_->time_base);
      code = av_write_frame(format_, packet_);
      av_packet_unref(packet_);
      if (code < 0) return failed("cannot be written", code);
      if (format_->pb->error < 0) return failed("cannot be written", format_->pb->error);
    }
    return {};
  }

  Status finish() override {
    int code = av_write_trailer(format_);
    if (code < 0) return failed("cannot be written", code);
    if (format_->pb->error < 0) return failed("cannot be written", format_->pb->error);
    code = avio_closep(&format_->pb);
    return code < 0 ? Status(failed("cannot be written", code)) : Status();
  }

 private:
  Failure failed(const std::string& what, int code) const { return av_failure(what, code, path_); }

  std::string path_;
  ClipFormat clip_format_;
  std::vector<std::uint8_t> header_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;
  AVPacket* packet_ = nullptr;
  std::int64_t frames_ = 0;
};

// A file that is being read; closes itself.
struct OpenVideo {
  AVFormatContext* format = nullptr;
  AVPacket* packet = nullptr;
  ~OpenVideo() {
    av_packet_free(&packet);
    avformat_close_input(&format);
  }
};

constexpr std::int64_t kMostPixels = 64'000'000;  // of a picture that is read

// Decodes; in the process of its own.
class DecodedClip {
 public:
  explicit DecodedClip(std::string path) : path_(std::move(path)) {}
  ~DecodedClip() {
    sws_freeContext(scaler_);
    av_frame_free(&frame_);
    avcodec_free_context(&codec_);
  }

  Status begin() {
    int code = avformat_open_input(&video_.format, path_.c_str(), nullptr, nullptr);
    if (code < 0) return failed("cannot be opened", code);
    code = avformat_find_stream_info(video_.format, nullptr);
    if (code < 0) return failed("cannot be read", code);
    index_ = av_find_best_stream(video_.format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (index_ < 0) return failed("has no pictures", 0);
    const AVCodecParameters* parameters = video_.format->streams[index_]->codecpar;
    const AVCodec* decoder = avcodec_find_decoder(parameters->codec_id);
    codec_ = decoder == nullptr ? nullptr : avcodec_alloc_context3(decoder);
    frame_ = av_frame_alloc();
    video_.packet = av_packet_alloc();
    if (codec_ == nullptr || frame_ == nullptr || video_.packet == nullptr)
      return failed("cannot be decoded", 0);
    code = avcodec_parameters_to_context(codec_, parameters);
    if (code < 0) return failed("cannot be decoded", code);
    codec_->thread_count = 1;
    codec_->err_recognition = AV_EF_EXPLODE;
    code = avcodec_open2(codec_, decoder, nullptr);
    if (code < 0) return failed("cannot be decoded", code);
    if (codec_->width <= 0 || codec_->height <= 0) return failed("has pictures without size", 0);
    if (std::int64_t{codec_->width} * codec_->height > kMostPixels)
      return failed("has pictures of more than " + std::to_string(kMostPixels) + " pixels", 0);
    // The scaler ends the program where it is given another.
    colours_ = codec_->pix_fmt;
    if (sws_isSupportedInput(colours_) == 0) return failed("does not say what its pixels are", 0);
    scaler_ = sws_getContext(codec_->width, codec_->height, colours_, codec_->width, codec_->height,
                             AV_PIX_FMT_RGB24, SWS_BILINEAR | SWS_BITEXACT | SWS_ACCURATE_RND,
                             nullptr, nullptr, nullptr);
    if (scaler_ == nullptr) return failed("no colour conversion", 0);
    rgb_bytes_ = 3 * static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    rgb_.resize(rgb_bytes_ + 64);  // the scaler may write a few bytes behind a row's end
    return {};
  }

  int width() const { return codec_->width; }
  int height() const { return codec_->height; }

  Result<std::span<const std::uint8_t>> next() {
    for (;;) {
      int code = avcodec_receive_frame(codec_, frame_);
      if (code == AVERROR_EOF) return std::span<const std::uint8_t>();
      if (code >= 0) return shown();
      if (code != AVERROR(EAGAIN)) return failed("cannot be decoded", code);
      PROBE_TRY(feed());
    }
  }

 private:
  Failure failed(const std::string& what, int code) const { return av_failure(what, code, path_); }

  // The next packet of the pictures, or the word that there are no more.
  Status feed() {
    for (;;) {
      int code = av_read_frame(video_.format, video_.packet);
      if (code < 0 && code != AVERROR_EOF) return failed("cannot be read to its end", code);
      const bool is_end = code == AVERROR_EOF;
      if (!is_end && video_.packet->stream_index != index_) {
        av_packet_unref(video_.packet);
        continue;
      }
      code = avcodec_send_packet(codec_, is_end ? nullptr : video_.packet);
      av_packet_unref(video_.packet);
      return code < 0 ? Status(failed("cannot be decoded", code)) : Status();
    }
  }

  Result<std::span<const std::uint8_t>> shown() {
    if (frame_->width != width() || frame_->height != height())
      return failed("changes the size of its pictures", 0);
    if (frame_->format != colours_) return failed("changes what its pixels are", 0);
    std::uint8_t* rows[] = {rgb_.data()};
    const int strides[] = {3 * width()};
    sws_scale(scaler_, frame_->data, frame_->linesize, 0, height(), rows, strides);
    return std::span<const std::uint8_t>(rgb_).first(rgb_bytes_);
  }

  std::string path_;
  OpenVideo video_;
  int index_ = -1;
  AVCodecContext* codec_ = nullptr;
  AVFrame* frame_ = nullptr;
  SwsContext* scaler_ = nullptr;
  AVPixelFormat colours_ = AV_PIX_FMT_NONE;  // that it takes
  std::size_t rgb_bytes_ = 0;
  std::vector<std::uint8_t> rgb_;
};

// ---- what the two processes say to each other: one of these, then what belongs to it

enum class Said : std::uint8_t { kSize, kPicture, kEnd, kFailure };

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The failure's message behind its size.
bool say(const Failure& failure, const AnswerWriter& write) {
  ByteWriter out;
  out.u8(static_cast<std::uint8_t>(Said::kFailure));
  out.text(failure.message);
  return write(as_text(out.bytes()));
}

bool decode_all(const std::string& path, const AnswerWriter& write) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong with a file is told by its failure
  DecodedClip clip(path);
  if (const Status begun = clip.begin(); !begun) return say(begun.failure(), write);
  ByteWriter size;
  size.u8(static_cast<std::uint8_t>(Said::kSize));
  size.u32(static_cast<std::uint32_t>(clip.width()));
  size.u32(static_cast<std::uint32_t>(clip.height()));
  if (!write(as_text(size.bytes()))) return false;
  for (;;) {
    const auto picture = clip.next();
    if (!picture) return say(picture.failure(), write);
    const char kind = static_cast<char>(picture->empty() ? Said::kEnd : Said::kPicture);
    if (!write({&kind, 1})) return false;
    if (picture->empty()) return true;
    if (!write(as_text(std::as_bytes(*picture)))) return false;
  }
}

// A video that a process of its own decodes.
class ClipApart final : public ClipReader {
 public:
  explicit ClipApart(std::string path) : path_(std::move(path)) {}

  Status begin() {
    auto stream =
        ApartStream::start([this](const AnswerWriter& write) { return decode_all(path_, write); });
    if (!stream) return failed(stream.failure().message);
    stream_ = std::move(*stream);
    PROBE_ASSIGN(const Said said, hear());
    if (said != Said::kSize) return failed("makes its reader give half an answer");
    std::array<char, 2 * sizeof(std::uint32_t)> bytes{};
    PROBE_TRY(read(bytes));
    ByteReader in(std::as_bytes(std::span(bytes)));
    const std::size_t width = in.u32(), height = in.u32();
    constexpr std::size_t kMostSide = 65536, kMostBytes = std::size_t{1} << 30;
    if (width == 0 || height == 0 || width > kMostSide || height > kMostSide ||
        3 * width * height > kMostBytes)
      return failed("has pictures of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels");
    width_ = static_cast<int>(width);
    height_ = static_cast<int>(height);
    rgb_.resize(3 * width * height);
    return {};
  }

  int width() const override { return width_; }
  int height() const override { return height_; }

  Result<std::span<const std::uint8_t>> next() override {
    if (has_ended_) return std::span<const std::uint8_t>();
    PROBE_ASSIGN(const Said said, hear());
    if (said == Said::kEnd) {
      has_ended_ = true;
      return std::span<const std::uint8_t>();
    }
    if (said != Said::kPicture) return failed("makes its reader give half an answer");
    PROBE_TRY(read({reinterpret_cast<char*>(rgb_.data()), rgb_.size()}));
    return std::span<const std::uint8_t>(rgb_);
  }

 private:
  Failure failed(std::string what) const { return {Fault::kVideo, std::move(what), path_}; }

  Status read(std::span<char> bytes) {
    const Status status = stream_->read(bytes);
    return status ? Status() : Status(failed(status.failure().message));
  }

  // What comes next; its failure, where that is one.
  Result<Said> hear() {
    std::array<char, 1> kind{};
    PROBE_TRY(read(kind));
    const auto said = static_cast<Said>(kind[0]);
    if (said != Said::kFailure) return said;
    std::array<char, sizeof(std::uint32_t)> size{};
    PROBE_TRY(read(size));
    constexpr std::uint32_t kMostText = 65536;
    std::string message(std::min(ByteReader(std::as_bytes(std::span(size))).u32(), kMostText),
                        '\0');
    PROBE_TRY(read(message));
    return failed(std::move(message));
  }

  std::string path_;
  std::unique_ptr<ApartStream> stream_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> rgb_;
  bool has_ended_ = false;
};

// In the process of its own.
Result<VideoFacts> facts_of(const std::string& path) {
  av_log_set_level(AV_LOG_QUIET);  // as above
  OpenVideo video;
  int code = avformat_open_input(&video.format, path.c_str(), nullptr, nullptr);
  if (code < 0) return av_failure("cannot be opened", code, path);
  code = avformat_find_stream_info(video.format, nullptr);
  if (code < 0) return av_failure("cannot be read", code, path);
  const int index = av_find_best_stream(video.format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return av_failure("has no pictures", 0, path);
  const AVStream& stream = *video.format->streams[index];
  VideoFacts facts;
  facts.codec = avcodec_get_name(stream.codecpar->codec_id);
  facts.width = stream.codecpar->width;
  facts.height = stream.codecpar->height;
  facts.frames_per_second = av_q2d(stream.avg_frame_rate);
  facts.is_even = facts.frames_per_second > 0;
  video.packet = av_packet_alloc();
  while ((code = av_read_frame(video.format, video.packet)) >= 0) {
    if (video.packet->stream_index == index) {
      const double shown = static_cast<double>(video.packet->pts) * av_q2d(stream.time_base);
      const double wanted = static_cast<double>(facts.frames) / facts.frames_per_second;
      if (facts.is_even && std::abs(shown - wanted) > 1e-6) facts.is_even = false;
      ++facts.frames;
    }
    av_packet_unref(video.packet);
  }
  if (code != AVERROR_EOF) return av_failure("cannot be read to its end", code, path);
  return facts;
}

}  // namespace

std::size_t Clip::bytes() const {
  std::size_t sum = 0;
  for (const Packet& packet : packets) sum += packet.bytes.size();
  return sum;
}

Result<std::unique_ptr<ClipEncoder>> ClipEncoder::create(const ClipFormat& format) {
  av_log_set_level(AV_LOG_ERROR);
  auto encoder = std::make_unique<X264Clip>(format);
  PROBE_TRY(encoder->begin());
  return std::unique_ptr<ClipEncoder>(std::move(encoder));
}

Result<std::unique_ptr<ClipJoiner>> ClipJoiner::create(const std::string& path, const Clip& first) {
  auto joiner = std::make_unique<Mp4Joiner>(path);
  PROBE_TRY(joiner->begin(first));
  return std::unique_ptr<ClipJoiner>(std::move(joiner));
}

std::string video_library() { return "libavcodec " + std::to_string(avcodec_version()); }

Result<std::unique_ptr<ClipReader>> ClipReader::create(const std::string& path) {
  auto reader = std::make_unique<ClipApart>(path);
  PROBE_TRY(reader->begin());
  return std::unique_ptr<ClipReader>(std::move(reader));
}

Result<VideoFacts> read_video_facts(const std::string& path) {
  const auto answer = run_apart([&](const AnswerWriter& write) {
    const auto facts = facts_of(path);
    if (!facts) return say(facts.failure(), write);
    ByteWriter out;
    out.u8(static_cast<std::uint8_t>(Said::kSize));
    out.text(facts->codec);
    out.u32(static_cast<std::uint32_t>(facts->width));
    out.u32(static_cast<std::uint32_t>(facts->height));
    out.f64(facts->frames_per_second);
    out.u64(static_cast<std::uint64_t>(facts->frames));
    out.u8(facts->is_even ? 1 : 0);
    return write(as_text(out.bytes()));
  });
  const auto failed = [&](std::string what) {
    return Failure{Fault::kVideo, std::move(what), path};
  };
  if (!answer) return failed(answer.failure().message);
  ByteReader in(std::as_bytes(std::span(answer->bytes())));
  const auto said = static_cast<Said>(in.u8());
  VideoFacts facts;
  std::string text = in.text();
  if (said == Said::kFailure && in.ok()) return failed(std::move(text));
  facts.codec = std::move(text);
  facts.width = static_cast<int>(in.u32());
  facts.height = static_cast<int>(in.u32());
  facts.frames_per_second = in.f64();
  facts.frames = static_cast<std::int64_t>(in.u64());
  facts.is_even = in.u8() == 1;
  if (!in.ok()) return failed("makes its reader give half an answer");
  return facts;
}

}  // namespace probe::show

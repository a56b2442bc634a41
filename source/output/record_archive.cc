#include <squeal/base/checksum.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/record_archive.h>

#include <cerrno>
#include <fstream>
#include <string_view>
#include <utility>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    /// Stands before every record.
    struct Head
    {
      std::uint64_t size = 0, checksum = 0;
    };

    std::string_view as_text(const std::vector<char> &record)
    {
      return {record.data(), record.size()};
    }
  } // namespace

  RecordArchive::RecordArchive(fs::path file)
    : file(std::move(file))
  {}

  std::string RecordArchive::identity() const
  {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
      throw fs::filesystem_error("read", file, std::error_code(errno, std::generic_category()));
    std::string text;
    std::getline(stream, text, '\0');
    return text;
  }

  void RecordArchive::begin(const std::string &identity)
  {
    replace_file(file, {identity.c_str(), identity.size() + 1});
    end = identity.size() + 1;
  }

  void RecordArchive::read(const std::function<void(const std::vector<char> &)> &action)
  {
    std::ifstream        stream(file, std::ios::binary);
    const std::uintmax_t size = fs::file_size(file);
    end                       = identity().size() + 1;
    stream.seekg(static_cast<std::streamoff>(end));
    for (Head head; end + sizeof(head) <= size; end += sizeof(head) + head.size)
      {
        stream.read(reinterpret_cast<char *>(&head), sizeof(head));
        if (stream && head.size > size - end - sizeof(head))
          break;
        std::vector<char> record(stream ? head.size : 0);
        if (!stream.read(record.data(), static_cast<std::streamsize>(record.size())))
          throw fs::filesystem_error("read", file, std::make_error_code(std::errc::io_error));
        if (checksum(as_text(record)) == head.checksum)
          action(record);
      }
    fs::resize_file(file, end);
  }

  void RecordArchive::append(const std::vector<char> &record)
  {
    const Head head{record.size(), checksum(as_text(record))};
    fs::resize_file(file, end);
    append_to_file(file, {{reinterpret_cast<const char *>(&head), sizeof(head)}, as_text(record)});
    end += sizeof(head) + record.size();
  }
} // namespace Squeal

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * A file that only grows: a text that identifies it, then binary records, each with its size and a checksum. append() returns
   * when the disk has the record. What a killed run or a full disk leaves of one is cut off when the file is read or the
   * next one comes: all records before it are there at every moment. To append costs what a record costs, however
   * many there are, while a file that replaces the former one would cost all of them every time.
   *
   * All functions throw std::filesystem::filesystem_error if the file cannot be read or written.
   */
  class RecordArchive
  {
  public:
    explicit RecordArchive(std::filesystem::path file);

    /// The text with which the file begins.
    std::string identity() const;

    /// Begins the file, or begins it anew; at every moment there is the old one or the new one.
    void begin(const std::string &identity);

    /// Calls @p action with every record in their order, but for damaged ones.
    void read(const std::function<void(const std::vector<char> &)> &action);

    /// Adds a record after begin() or read(). If that fails, another attempt may succeed.
    void append(const std::vector<char> &record);

    const std::filesystem::path file;

  private:
    std::uintmax_t end = 0; ///< of the last record [byte]
  };
} // namespace Squeal

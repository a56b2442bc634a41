#pragma once

#include <filesystem>
#include <string>

namespace Squeal
{
  /**
   * Keeps other runs out of a folder while this one writes to it: a file beside
   * it that names the run and is locked. The kernel releases the lock when the
   * process ends, however it ends; the file is then left behind. Where the file
   * system knows no locks, nobody is kept out.
   */
  class FolderLock
  {
  public:
    /**
     * @param file    of the lock
     * @param folder  that it keeps, for messages
     * @param command of this run, for the messages of others
     *
     * Throws FileError that names the other run if there is one; or if the file cannot be made, or holds something else.
     */
    FolderLock(const std::filesystem::path &file, const std::string &folder, const std::string &command);

    /// Removes the file and releases the lock.
    ~FolderLock();

    FolderLock(const FolderLock &)            = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    /// Whether a run that was killed had left the file behind.
    bool was_left_behind() const;

  private:
    const std::filesystem::path file;
    int                         descriptor  = -1;
    bool                        left_behind = false;
  };
} // namespace Squeal

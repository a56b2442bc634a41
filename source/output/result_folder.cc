#include <squeal/base/exceptions.h>
#include <squeal/output/result_folder.h>

#include <filesystem>
#include <fstream>

namespace Squeal
{
  namespace fs = std::filesystem;

  ResultFolder::ResultFolder(const std::string &directory_name, const bool is_root)
    : directory(fs::path(directory_name).lexically_normal().string())
    , is_root(is_root)
  {
    while (directory.size() > 1 && directory.back() == '/')
      directory.pop_back();
    temporary = directory + ".unfinished";
    if (!is_root)
      return;
    if (directory.empty())
      throw FileError("the name of the result folder is empty", "--output", "name a folder");
    try
      {
        if (fs::exists(directory) && !fs::is_directory(directory))
          throw FileError("`" + directory + "` is a file, not a folder", "--output", "choose another name");
        if (fs::exists(directory) && !fs::is_empty(directory) && !fs::exists(fs::path(directory) / run_record))
          throw FileError("the folder `" + directory + "` holds files that are not the results of a run", "--output",
                          "choose another name, or empty the folder");
        fs::remove_all(temporary);
        fs::create_directories(temporary);
      }
    catch (const fs::filesystem_error &error)
      {
        throw FileError(std::string("the result folder cannot be created: ") + error.code().message(), "--output " + directory,
                        "choose a folder that you may write to");
      }
  }

  ResultFolder::~ResultFolder()
  {
    std::error_code ignored;
    if (is_root && !committed)
      fs::remove_all(temporary, ignored);
  }

  std::string ResultFolder::path(const std::string &name) const
  {
    const fs::path file = fs::path(temporary) / name;
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    return file.string();
  }

  void ResultFolder::write(const std::string &name, const std::function<void(std::ostream &)> &writer) const
  {
    if (!is_root)
      return;
    std::ofstream stream(path(name));
    writer(stream);
    stream.close();
    if (!stream)
      throw FileError("the file cannot be written", "file " + directory + "/" + name, "check permissions and free space");
  }

  bool ResultFolder::writes_here() const
  {
    return is_root;
  }

  void ResultFolder::commit()
  {
    if (is_root)
      try
        {
          const std::string replaced = directory + ".replaced";
          fs::remove_all(replaced);
          if (fs::exists(directory))
            fs::rename(directory, replaced);
          fs::rename(temporary, directory);
          fs::remove_all(replaced);
        }
      catch (const fs::filesystem_error &error)
        {
          throw FileError(std::string("the results cannot be moved to their place: ") + error.code().message(), "--output " + directory,
                          "choose a folder that you may write to");
        }
    committed = true;
  }

  const std::string &ResultFolder::name() const
  {
    return directory;
  }
} // namespace Squeal

#include <squeal/base/mpi_environment.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

using namespace Squeal;

namespace
{
  constexpr const char *n_processes = "OMPI_COMM_WORLD_LOCAL_SIZE", *yields = "OMPI_MCA_mpi_yield_when_idle",
                       *is_isolated = "OMPI_MCA_ess_singleton_isolated", *has_folder = "OMPI_MCA_orte_create_session_dirs";

  /// Without the variables, which come back at the end.
  class MpiEnvironment : public ::testing::Test
  {
  protected:
    MpiEnvironment()
    {
      for (const char *name : {n_processes, yields, is_isolated, has_folder})
        {
          if (const char *value = std::getenv(name))
            former[name] = value;
          unsetenv(name);
        }
    }
    ~MpiEnvironment() override
    {
      for (const char *name : {n_processes, yields, is_isolated, has_folder})
        unsetenv(name);
      for (const auto &[name, value] : former)
        setenv(name.c_str(), value.c_str(), 1);
    }
    std::map<std::string, std::string> former;
  };
} // namespace

TEST_F(MpiEnvironment, OfMoreProcessesThanCores)
{
  setenv(n_processes, "1", 1);
  prepare_mpi_environment();
  EXPECT_EQ(std::getenv(yields), nullptr);
  setenv(n_processes, "1000000", 1);
  prepare_mpi_environment();
  EXPECT_STREQ(std::getenv(yields), "1");
  // The user's choice stays.
  setenv(yields, "0", 1);
  prepare_mpi_environment();
  EXPECT_STREQ(std::getenv(yields), "0");
  EXPECT_EQ(std::getenv(is_isolated), nullptr);
  EXPECT_EQ(std::getenv(has_folder), nullptr);
}

TEST_F(MpiEnvironment, WithoutMpirun)
{
  prepare_mpi_environment();
  EXPECT_STREQ(std::getenv(is_isolated), "1");
  EXPECT_STREQ(std::getenv(has_folder), "0");
  EXPECT_EQ(std::getenv(yields), nullptr);
}

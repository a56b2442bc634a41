#pragma once

#include <squeal/linear_algebra/row_map.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <vector>

namespace Squeal
{
  /// Brings values of rows that other processes own, one for each of a list of row numbers.
  class GhostExchange
  {
  public:
    GhostExchange() = default;

    /// @p ghosts: numbers of rows of @p map that this process wants and does not own. All processes must call.
    GhostExchange(const RowMap &map, const std::vector<int> &ghosts)
      : communicator(map.communicator())
      , n_ghosts(static_cast<int>(ghosts.size()))
    {
      if (map.n_processes() == 1)
        return;
      const auto                               wanted = dealii::Utilities::MPI::all_gather(communicator, ghosts);
      std::map<unsigned int, std::vector<int>> positions; // in the list of the process that wants them
      for (unsigned int process = 0; process < wanted.size(); ++process)
        for (std::size_t i = 0; i < wanted[process].size(); ++i)
          if (const int place = map.place(wanted[process][i]); place >= 0)
            {
              send[process].push_back(place);
              positions[process].push_back(static_cast<int>(i));
            }
      receive = dealii::Utilities::MPI::some_to_some(communicator, positions);
    }

    int size() const
    {
      return n_ghosts;
    }

    /// ghosts[i] = value of the i-th wanted row; @p own: of the rows of this process. All processes must call.
    template <typename Value>
    void operator()(const Value *own, Value *ghosts) const
    {
      if (send.empty() && receive.empty())
        return;
      constexpr int                   tag = 7411;
      std::vector<std::vector<Value>> out, in;
      std::vector<MPI_Request>        requests;
      for (const auto &[process, positions] : receive)
        {
          in.emplace_back(positions.size());
          MPI_Irecv(in.back().data(), static_cast<int>(in.back().size() * sizeof(Value)), MPI_BYTE, static_cast<int>(process), tag,
                    communicator, &requests.emplace_back());
        }
      for (const auto &[process, places] : send)
        {
          out.emplace_back();
          for (const int place : places)
            out.back().push_back(own[place]);
          MPI_Isend(out.back().data(), static_cast<int>(out.back().size() * sizeof(Value)), MPI_BYTE, static_cast<int>(process), tag,
                    communicator, &requests.emplace_back());
        }
      MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
      auto values = in.begin();
      for (const auto &[process, positions] : receive)
        {
          for (std::size_t i = 0; i < positions.size(); ++i)
            ghosts[positions[i]] = (*values)[i];
          ++values;
        }
    }

  private:
    MPI_Comm                                 communicator = MPI_COMM_SELF;
    int                                      n_ghosts     = 0;
    std::map<unsigned int, std::vector<int>> send;    ///< places of own rows, for each process that wants some
    std::map<unsigned int, std::vector<int>> receive; ///< positions among the ghosts, for each process that owns some
  };
} // namespace Squeal

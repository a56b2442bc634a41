#include <squeal/linear_algebra/row_map.h>

#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>

#include <algorithm>

namespace Squeal
{
  RowMap::RowMap(const Epetra_Map &map)
    : map(std::make_shared<const Epetra_Map>(map))
  {}

  RowMap RowMap::even(const int n, const MPI_Comm communicator)
  {
    return RowMap(Epetra_Map(n, 0, Epetra_MpiComm(communicator)));
  }

  RowMap RowMap::contiguous(const int n_local, const MPI_Comm communicator)
  {
    return RowMap(Epetra_Map(-1, n_local, 0, Epetra_MpiComm(communicator)));
  }

  RowMap RowMap::of(const std::vector<int> &numbers, const MPI_Comm communicator)
  {
    return RowMap(Epetra_Map(-1, static_cast<int>(numbers.size()), numbers.data(), 0, Epetra_MpiComm(communicator)));
  }

  int RowMap::n() const
  {
    return map ? map->NumGlobalElements() : 0;
  }

  int RowMap::n_local() const
  {
    return map ? map->NumMyElements() : 0;
  }

  int RowMap::number(const int place) const
  {
    return map->GID(place);
  }

  int RowMap::place(const int number) const
  {
    return number < 0 ? -1 : map->LID(number);
  }

  MPI_Comm RowMap::communicator() const
  {
    return map ? dynamic_cast<const Epetra_MpiComm &>(map->Comm()).Comm() : MPI_COMM_SELF;
  }

  int RowMap::rank() const
  {
    return map ? map->Comm().MyPID() : 0;
  }

  int RowMap::n_processes() const
  {
    return map ? map->Comm().NumProc() : 1;
  }

  bool RowMap::operator==(const RowMap &other) const
  {
    if (map == other.map || !map || !other.map)
      return map == other.map;
    // Epetra asks all processes, even where there is no other one: any thread may compare
    if (n_processes() == 1 && other.n_processes() == 1)
      return n_local() == other.n_local() &&
             std::equal(map->MyGlobalElements(), map->MyGlobalElements() + n_local(), other.map->MyGlobalElements());
    return map->SameAs(*other.map);
  }

  const Epetra_Map &RowMap::implementation() const
  {
    return *map;
  }
} // namespace Squeal

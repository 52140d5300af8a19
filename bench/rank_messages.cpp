/// @file
/// Cost of messages for the writer of a map on several ranks: the calls of cli/ranks/ranks.cpp without anything else.
///   mpirun -n 2 rank_messages      prints the round trip of one message; with more ranks, the writer's time for each
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace {

constexpr int messages = 10'000;
constexpr std::size_t row_bytes = 32 + 8 * 9;  // one point of a map with one method: head, index, eight numbers

/// Waits for a message as cli/ranks/ranks.cpp does, but without pauses.
int received(std::string& into) {
  int arrived = 0;
  MPI_Status status;
  while (arrived == 0) MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, &status);
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  into.assign(static_cast<std::size_t>(size), '\0');
  MPI_Recv(into.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return status.MPI_SOURCE;
}

void send(int to, const std::string& content) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(content.data(), static_cast<int>(content.size()), MPI_BYTE, to, 1, MPI_COMM_WORLD, &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
}

/// Takes rows from any sender, and returns the next points to it. Seconds a message: of many hundreds, the fastest
/// quarter, as in the others this or another process was interrupted.
double serve(int others) {
  std::string rows;
  const std::string points(sizeof(std::size_t), 'p');
  std::vector<double> hundreds;
  for (int i = 0; i < others * messages; i += 100) {
    const double begin = MPI_Wtime();
    for (int k = 0; k < 100; ++k) send(received(rows), points);
    hundreds.push_back((MPI_Wtime() - begin) / 100);
  }
  const auto quarter = hundreds.begin() + static_cast<std::ptrdiff_t>(hundreds.size() / 4);
  std::nth_element(hundreds.begin(), quarter, hundreds.end());
  return *quarter;
}

void ask() {
  std::string points;
  const std::string rows(row_bytes, 'r');
  for (int i = 0; i < messages; ++i) {
    send(0, rows);
    received(points);
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, count = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  if (rank == 0 && count > 1)
    std::printf("%.9f\n", serve(count - 1));
  else if (rank > 0)
    ask();
  MPI_Finalize();
  return count > 1 ? 0 : 2;
}

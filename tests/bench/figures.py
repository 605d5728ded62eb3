"""How the benchmarks in Python measure and print: medians (least - greatest) of 15 runs after three, in ms."""
import time

RUNS, WARM = 15, 3


def measured(work, before=lambda: None):
    """The median, least and greatest time of `work`; `before` each run something that is not measured."""
    times = []
    for _ in range(WARM + RUNS):
        before()
        start = time.perf_counter()
        work()
        times.append(1000 * (time.perf_counter() - start))
    times = sorted(times[WARM:])
    return times[RUNS // 2], times[0], times[-1]


def row(name, figure, ratio=None):
    print(f"{name:58} {figure[0]:8.2f} ({figure[1]:.2f} - {figure[2]:.2f})" + ("" if ratio is None else f"   {ratio:.1f}"))

#!/usr/bin/env python3
"""Measures the service under load and writes docs/service.md and docs/service.json.

  tests/bench/service.py [--binary build/release/bin/translucube] [--out docs] [--quick]

Needs wrk (Debian's package). Takes about three minutes on two cores; --quick a fifth of it.
Targets are those of the project's issue on the service; each is printed with what was measured.
"""

import argparse
import http.client
import json
import os
import re
import subprocess
import tempfile
import threading
import time

PORT_LINE = re.compile(r"listening on http://[^:]+:(\d+)")


class Service:
    """A service of its own in a temporary folder."""

    def __init__(self, binary, folder):
        self.process = subprocess.Popen(
            [binary, "serve", "--port", "0", "--data", folder],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.port = int(PORT_LINE.match(self.process.stdout.readline()).group(1))

    def call(self, method, path, body=None, connection=None):
        client = connection or http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        client.request(method, path, json.dumps(body) if body is not None else None,
                       {"Content-Type": "application/json"} if body is not None else {})
        answer = client.getresponse()
        text = answer.read()
        if answer.status >= 400:
            raise RuntimeError(f"{method} {path}: {answer.status} {text[:300]}")
        return json.loads(text) if answer.getheader("Content-Type") == "application/json" else text

    def resident_mb(self):
        with open(f"/proc/{self.process.pid}/status") as status:
            return int(re.search(r"VmRSS:\s+(\d+) kB", status.read()).group(1)) / 1024

    def request_cpu_s(self):
        """CPU time so far of the threads that answer: all but the workers, which are nicer."""
        total, own = 0, os.getpriority(os.PRIO_PROCESS, self.process.pid)
        tasks = f"/proc/{self.process.pid}/task"
        for task in os.listdir(tasks):
            try:
                with open(f"{tasks}/{task}/stat") as stat, \
                        open(f"{tasks}/{task}/schedstat") as spent:
                    nice = int(stat.read().rpartition(")")[2].split()[16])
                    total += int(spent.read().split()[0]) / 1e9 if nice == own else 0
            except FileNotFoundError:
                pass  # a thread that has ended
        return total

    def metric(self, name):
        text = self.call("GET", "/metrics").decode()
        return float(re.search(rf"^{re.escape(name)} (\S+)$", text, re.M).group(1))

    def stop(self):
        self.process.terminate()
        self.process.wait(30)


def render(seed, size=128, samples=16, absorption=0.3, roughness=0.0, scattering=0.5):
    return {"material": {"cube": {"absorption": absorption, "roughness": roughness,
                                  "scattering": scattering}},
            "image": {"width": size, "height": size}, "quality": {"samples": samples},
            "seed": seed}


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


class Wrk(threading.Thread):
    """Asks again and again, from 16 connections, about so many times a second."""

    def __init__(self, url, seconds, rate):
        super().__init__()
        self.url, self.seconds, self.rate = url, seconds, rate

    def run(self):
        connections = 16
        with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
            pause = max(0, round(1000 * connections / self.rate)) if self.rate else 0
            script.write(f"function delay() return {pause} end\n" if self.rate else "")
            script.flush()
            start = time.time()
            process = subprocess.Popen(
                ["wrk", "-t1", f"-c{connections}", f"-d{self.seconds}s", "--latency",
                 "-s", script.name, self.url], stdout=subprocess.PIPE, text=True)
            self.text = process.stdout.read()
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode != 0:
                raise RuntimeError("wrk failed")
            self.cores = (used.ru_utime + used.ru_stime) / (time.time() - start)

    def figures(self):
        unit = {"us": 1e-3, "ms": 1.0, "s": 1e3}
        p99 = re.search(r"99%\s+([\d.]+)(us|ms|s)", self.text)
        errors = re.search(r"Non-2xx or 3xx responses: (\d+)", self.text)
        return {"requests_per_s": float(re.search(r"Requests/sec:\s+([\d.]+)", self.text).group(1)),
                "p99_ms": float(p99.group(1)) * unit[p99.group(2)],
                "wrk_cores": self.cores,
                "errors": int(errors.group(1)) if errors else 0}


def rendered_per_second(service, seconds, seeds, during=None):
    """Camera samples a second while two renders run at all times."""
    count = max(8, round(40 * seconds))
    for _ in range(count):
        service.call("POST", "/v1/renders", render(next(seeds)))
    time.sleep(1)
    if during:
        during.start()
    used = service.request_cpu_s()
    before, start = service.metric("translucube_camera_samples_total"), time.time()
    time.sleep(seconds)
    took = time.time() - start
    rate = (service.metric("translucube_camera_samples_total") - before) / took
    request_cores = (service.request_cpu_s() - used) / took
    if during:
        during.join()
    cursor = ""
    while True:  # what is left of them
        page = service.call("GET", f"/v1/renders?status=queued&limit=200{cursor}")
        for waiting in page["renders"]:
            service.call("POST", waiting["links"]["cancel"], {})
        if not page["next_cursor"]:
            break
    while service.call("GET", "/v1/renders?status=running")["renders"]:
        time.sleep(0.1)
    return rate, request_cores


def wait_for(service, link):
    while True:
        status = service.call("GET", link + "?wait=60")
        if status["state"] not in ("queued", "running"):
            return status


def measure_requests(service, seconds):
    seeds = iter(range(1000, 10**9))
    done = wait_for(service, service.call("POST", "/v1/renders", render(1, 64, 4))["links"]["self"])
    image = done["links"]["image"] + "?format=png"
    service.call("GET", image)
    rows = {}
    base = f"http://127.0.0.1:{service.port}"
    for name, path in (("status", done["links"]["self"]), ("cached image", image)):
        alone = Wrk(base + path, max(2, seconds // 2), None)
        alone.start()
        alone.join()
        undisturbed, idle_cores = rendered_per_second(service, seconds, seeds)
        load = Wrk(base + path, seconds + 1, 2500)
        loaded, request_cores = rendered_per_second(service, seconds, seeds, load)
        again, _ = rendered_per_second(service, seconds, seeds)
        rows[name] = {"alone": alone.figures(), "with two renders": load.figures(),
                      "request_cores": request_cores - idle_cores,
                      "renders' speed": loaded / (0.5 * (undisturbed + again))}
    return rows


def measure_queue(service, count):
    blocker = service.call("POST", "/v1/renders", render(1, 1024, 4096))
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=120)
    times = []
    for seed in range(2, count + 2):
        start = time.time()
        service.call("POST", "/v1/renders", render(seed, 512, 4096), connection)
        times.append(time.time() - start)
    values = {"from": 0, "to": 1, "count": 21}
    sweep = {"base": render(1, 512, 4096),
             "axes": {"absorption": values, "roughness": values, "scattering": values}}
    start = time.time()
    accepted = service.call("POST", "/v1/sweeps", sweep)
    sweep_s = time.time() - start
    return {"renders": count, "slowest_s": max(times), "p99_s": percentile(times, 0.99),
            "all_s": sum(times), "sweep_points": accepted["points"], "sweep_s": sweep_s,
            "resident_mb": service.resident_mb(), "first": blocker["id"]}


def measure_sweep(service, size, samples):
    values = {"from": 0, "to": 1, "count": 5}
    base = render(7, size, samples)
    axes = {"absorption": values, "roughness": values, "scattering": values}
    one = {"absorption": [0.25], "roughness": values, "scattering": values}

    def run(axes):
        start = time.time()
        accepted = service.call("POST", "/v1/sweeps", {"base": base, "axes": axes})
        done = wait_for(service, accepted["links"]["self"])
        assert done["state"] == "succeeded", done["counts"]
        return time.time() - start, done

    single_s, single = run(one)
    base["seed"] = 8
    whole_s, whole = run(axes)
    again_s, _ = run(axes)
    return {"points": whole["points"], "traced_images": whole["traced_images"],
            "seconds": whole_s, "of_25_images": single_s, "ratio": whole_s / single_s,
            "asked_again_s": again_s, "single_traced": single["traced_images"]}


def document(figures):
    requests, queue, sweep = figures["requests"], figures["queue"], figures["sweep"]
    met = lambda good: "yes" if good else "**no**"
    lines = ["# The service under load", "",
             "Written by `tests/bench/service.py` from what it measures; do not edit. "
             f"{os.cpu_count()} cores, which wrk (1 thread, 16 connections) shares.", "",
             "## Requests that render nothing", "",
             "`alone`: as fast as wrk asks. `with two renders`: wrk asks at a steady pace of about "
             "2500/s while two renders (128 x 128, 16 samples) run at all times; the last figure is "
             "their speed, in camera samples a second, over that of the same renders before and "
             "after. `wrk's share` and `service's share` are the CPU time of wrk, and of the threads "
             "that answer, of the cores' time: what of the loss is wrk's own, which shares the "
             "cores.", "",
             "| | requests/s alone | p99 ms | requests/s with two renders | p99 ms | wrk's share "
             "| service's share | renders' speed | target | met |",
             "|---|--:|--:|--:|--:|--:|--:|--:|---|---|"]
    for name, row in requests.items():
        a, b, speed = row["alone"], row["with two renders"], row["renders' speed"]
        good = b["requests_per_s"] >= 2000 and b["p99_ms"] < 50 and speed > 0.85
        lines.append(f"| {name} | {a['requests_per_s']:.0f} | {a['p99_ms']:.1f} | "
                     f"{b['requests_per_s']:.0f} | {b['p99_ms']:.1f} | "
                     f"{b['wrk_cores'] / os.cpu_count():.1%} | "
                     f"{row['request_cores'] / os.cpu_count():.1%} | {speed:.2f} | "
                     f">= 2000/s, p99 < 50 ms, speed > .85 | {met(good)} |")
    lines += ["", "## A long queue", "",
              "| | measured | target | met |", "|---|--:|--:|---|",
              f"| {queue['renders']} renders queued, the slowest accepted in, s | "
              f"{queue['slowest_s']:.3f} | < 1 | {met(queue['slowest_s'] < 1)} |",
              f"| their 99 % quantile, ms | {1000 * queue['p99_s']:.1f} | | |",
              f"| sweep of {queue['sweep_points']} points accepted in, s | {queue['sweep_s']:.2f} | "
              f"< 1 | {met(queue['sweep_s'] < 1)} |",
              f"| resident memory then, MB (two 512 x 512 or larger renders run) | "
              f"{queue['resident_mb']:.0f} | < 200 | {met(queue['resident_mb'] < 200)} |",
              "", "## A sweep", "",
              "5 x 5 x 5 points against the 25 traced images of one absorption, both through the "
              "service.", "",
              "| | measured | target | met |", "|---|--:|--:|---|",
              f"| {sweep['points']} points from {sweep['traced_images']} traced images, s | "
              f"{sweep['seconds']:.1f} | | |",
              f"| 25 points from 25 traced images, s | {sweep['of_25_images']:.1f} | | |",
              f"| ratio | {sweep['ratio']:.2f} | < 1.3 | {met(sweep['ratio'] < 1.3)} |",
              f"| asked for again, s | {sweep['asked_again_s']:.2f} | | |", ""]
    return "\n".join(lines)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--binary", default="build/release/bin/translucube")
    arguments.add_argument("--out", default="docs")
    arguments.add_argument("--quick", action="store_true")
    options = arguments.parse_args()
    quick = options.quick
    figures = {}
    for name, measure in (
            ("sweep", lambda s: measure_sweep(s, 128 if quick else 256, 16 if quick else 32)),
            ("requests", lambda s: measure_requests(s, 3 if quick else 12)),
            ("queue", lambda s: measure_queue(s, 1000 if quick else 10000))):
        with tempfile.TemporaryDirectory() as folder:
            service = Service(options.binary, folder)
            try:
                figures[name] = measure(service)
            finally:
                service.stop()
        print(name, json.dumps(figures[name]), flush=True)
    os.makedirs(options.out, exist_ok=True)
    with open(os.path.join(options.out, "service.json"), "w") as file:
        json.dump(figures, file, indent=1)
        file.write("\n")
    with open(os.path.join(options.out, "service.md"), "w") as file:
        file.write(document(figures))


if __name__ == "__main__":
    main()

// From a state to pictures: traces what must be traced, develops the rest. The newest state wins;
// what it supersedes is canceled, nothing queues up.

import {developQuery, traceRequest} from './state.js';
import {hasEnded, Problem} from './service.js';

/// First a small film that is there at once, then the one of the size asked for.
const firstSize = 256, firstSamples = 16;

function stagesOf({size, samples}) {
  const last = {size, samples};
  return size > firstSize ? [{size: firstSize, samples: firstSamples}, last] : [last];
}

function traceKey(state) {
  return JSON.stringify([traceRequest(state, state.size, state.samples)]);
}

/// A render whose path lengths the service keeps: any absorber is developed from it.
class Film {
  samples = 0;
  error = null;
  done = false;

  constructor(id, stage) {
    this.id = id;
    this.size = stage.size;
    this.total = stage.samples;
  }
  get worth() {
    return this.samples * this.size * this.size;
  }
  learn(progress) {
    this.samples = Math.max(this.samples, progress.samples ?? 0);
    if (progress.relative_error !== undefined) this.error = progress.relative_error;
  }
}

export class Tracer {
  #service;
  #on;
  #state = null;
  #key = '';
  #wanted = null;      // what the next POST is for
  #posting = false;
  #run = null;         // {key, controller, films, stages}
  #developing = false;
  #again = false;

  /// `on`: {picture(blob, film, state), progress(film, run), problem(error), material(report)}.
  constructor(service, on) {
    this.#service = service;
    this.#on = on;
  }

  show(state) {
    this.#state = structuredClone(state);
    const key = traceKey(state);
    if (key === this.#key) {
      this.#develop();
      return;
    }
    this.#key = key;
    this.#wanted = {key, state: this.#state};
    this.#abandon();
    if (!this.#posting) this.#postWanted();
  }

  get film() {
    return this.#bestFilm();
  }

  #abandon() {
    if (!this.#run) return;
    this.#run.controller.abort();
    for (const film of this.#run.films) if (!film.done) this.#service.cancel(film.id);
    this.#run.stale = true;
  }

  async #postWanted() {
    this.#posting = true;
    while (this.#wanted) {
      const {key, state} = this.#wanted;
      this.#wanted = null;
      const run = {key, state, controller: new AbortController(), films: [], stages: stagesOf(state)};
      try {
        await this.#post(run);
      } catch (error) {
        if (!this.#wanted) {
          this.#key = '';  // the same again is worth a new try
          this.#on.problem(error);
        }
        continue;
      }
      if (this.#wanted) {
        for (const film of run.films) if (!film.done) this.#service.cancel(film.id);
        continue;
      }
      this.#run = run;
      this.#follow(run);
    }
    this.#posting = false;
  }

  /// Asks for the run's next stage.
  async #post(run) {
    const stage = run.stages.shift();
    const status = await this.#service.post(
        '/v1/renders', traceRequest(run.state, stage.size, stage.samples));
    const film = new Film(status.id, stage);
    this.#learnStatus(film, status);
    run.films.push(film);
    if (status.material) this.#on.material(status.material);
    return film;
  }

  #learnStatus(film, status) {
    film.learn(status.state === 'succeeded' ? status.stats : status.progress);
    film.done = hasEnded(status.state);
  }

  async #follow(run) {
    try {
      for (;;) {
        const film = run.films.at(-1);
        if (film.done) this.#changed(run, film);
        else await this.#watch(run, film);
        if (run.controller.signal.aborted) return;
        if (run.stages.length === 0) break;
        await this.#post(run);
        if (run.controller.signal.aborted) {
          this.#service.cancel(run.films.at(-1).id);
          return;
        }
      }
      this.#on.progress(run.films.at(-1), true);
    } catch (error) {
      if (!run.controller.signal.aborted) {
        this.#key = '';
        this.#on.problem(error);
      }
    }
  }

  async #watch(run, film) {
    let failure = null;
    await this.#service.follow(`/v1/renders/${film.id}/events`, {
      signal: run.controller.signal,
      onEvent: ({type, data}) => {
        if (type === 'preview' || type === 'progress') film.learn(data);
        if (type === 'state') {
          film.learn(data.progress);
          film.done = hasEnded(data.state);
          if (data.state === 'failed') failure = new Problem(data.error?.status ?? 500, data.error ?? {});
        }
        this.#changed(run, film);
      },
    });
    film.done = true;
    if (failure) throw failure;
  }

  #changed(run, film) {
    if (run !== this.#run) return;
    this.#on.progress(film, false);
    if (film.samples > 0) this.#develop();
  }

  #bestFilm() {
    const films = this.#run?.films.filter(film => film.samples > 0) ?? [];
    return films.reduce((best, film) => (best && best.worth > film.worth ? best : film), null);
  }

  /// Fetches the state's picture from the best film; asked for meanwhile, once more after that.
  async #develop() {
    if (this.#developing) {
      this.#again = true;
      return;
    }
    this.#developing = true;
    do {
      this.#again = false;
      const run = this.#run, film = this.#bestFilm(), state = this.#state;
      if (!run || run.stale || !film) continue;
      try {
        const samples = film.samples;
        const blob = await this.picture(film, state);
        if (run === this.#run && !run.stale) this.#on.picture(blob, film, state, samples);
      } catch (error) {
        if (run !== this.#run || run.stale || run.controller.signal.aborted) continue;
        const {status} = error;
        // Ended or canceled between the two calls: the events tell what comes next.
        if (status === 409) continue;
        if (status === 410) this.#key = '';  // removed to make room
        this.#on.problem(error);
      }
    } while (this.#again);
    this.#developing = false;
  }

  /// A film through the state's absorber.
  async picture(film, state, format = 'png') {
    const fields = new URLSearchParams({format, ...developQuery(state)});
    if (format === 'exr') {
      fields.delete('display');
      fields.delete('view');
    }
    if (!film.done) fields.set('partial', 'true');
    const response = await this.#service.call(`/v1/renders/${film.id}/image?${fields}`);
    return response.blob();
  }
}

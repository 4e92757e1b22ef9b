// From a state to pictures: traces what must be traced, develops the rest. The newest state wins;
// what it supersedes is removed, and nothing queues up: while a control moves, the next state waits
// for the first picture of the one before, then the newest is taken.

import {developQuery, displayQuery, pictureRequest, traceRequest} from './state.js';
import {hasEnded, Problem} from './service.js';

/// First a glance of one sample, which has no path lengths and so is there soonest; then a small
/// film that any absorber is developed from; then the one of the size asked for.
const firstSize = 256;
const glance = {size: firstSize, samples: 1, glance: true};

function stagesOf({size, samples}) {
  const last = {size, samples};
  return size > firstSize ? [{size: firstSize, samples: 16}, last] : [last];
}

const traceKey = state => JSON.stringify(traceRequest(state, state.size, state.samples));
const absorberKey = ({absorption, absorber}) => JSON.stringify([absorption, absorber]);

/// A render, and how far it is.
class Film {
  samples = 0;
  error = null;
  done = false;

  constructor(id, stage) {
    this.id = id;
    this.size = stage.size;
    this.total = stage.samples;
    this.glance = Boolean(stage.glance);
  }
  get worth() {
    return this.samples * this.size * this.size;
  }
  learn(progress) {
    this.samples = Math.max(this.samples, progress?.samples ?? 0);
    if (progress?.relative_error !== undefined) this.error = progress.relative_error;
  }
}

/// The renders of one state.
class Run {
  films = [];
  controller = new AbortController();
  young = true;    // no picture yet
  shown = '';      // what the last picture was of

  constructor(state, key, stages) {
    Object.assign(this, {state, key, stages});
  }
  get over() {
    return this.controller.signal.aborted;
  }
  /// The best film that can show the state.
  film(state) {
    const fits = film => film.samples > 0 &&
        (!film.glance || absorberKey(state) === absorberKey(this.state));
    return this.films.filter(fits)
        .reduce((best, film) => (best && best.worth > film.worth ? best : film), null);
  }
}

export class Tracer {
  #service;
  #on;
  #state = null;
  #key = '';
  #wanted = false;      // the newest state has no run yet
  #run = null;
  #posting = false;
  #developing = null;   // the promise of the pictures that are being fetched
  #again = false;
  #traced = new Set();  // keys whose films the service has

  /// `on`: {picture(blob, film, state, samples), progress(film, done), problem(error),
  /// material(report)}.
  constructor(service, on) {
    this.#service = service;
    this.#on = on;
  }

  show(state) {
    this.#state = structuredClone(state);
    this.#key = traceKey(state);
    this.#wanted = this.#run?.key !== this.#key;
    if (this.#wanted) this.#next();
    else this.#develop();
  }

  /// What the state's picture can be had from.
  get film() {
    return this.#run?.key === this.#key ? this.#run.film(this.#state) : null;
  }

  /// Begins with the newest state, unless the one before is about to show its first picture.
  async #next() {
    if (!this.#wanted || this.#posting || (this.#run?.young && !this.#run.over)) return;
    this.#wanted = false;
    this.#abandon();
    const known = this.#traced.has(this.#key);
    const stages = [...(known ? [] : [glance]), ...stagesOf(this.#state)];
    const run = new Run(this.#state, this.#key, stages);
    this.#run = run;
    this.#posting = true;
    try {
      await this.#post(run);
    } catch (error) {
      this.#fail(run, error);
    }
    this.#posting = false;
    if (!run.over) this.#follow(run);
    this.#next();
  }

  #abandon() {
    if (!this.#run) return;
    this.#run.controller.abort();
    for (const film of this.#run.films) if (film.glance || !film.done) this.#service.remove(film.id);
  }

  #fail(run, error) {
    if (run.over) return;
    run.controller.abort();
    run.key = '';  // the same again is worth a new try
    this.#on.problem(error);
    this.#next();
  }

  /// Asks for the run's next stage.
  async #post(run) {
    const stage = run.stages.shift();
    const request = stage.glance
        ? {...pictureRequest(run.state, stage.samples), image: {width: stage.size, height: stage.size}}
        : traceRequest(run.state, stage.size, stage.samples);
    const status = await this.#service.post('/v1/renders', request);
    const film = new Film(status.id, stage);
    film.learn(status.state === 'succeeded' ? status.stats : status.progress);
    film.done = hasEnded(status.state);
    if (run.over) this.#service.remove(film.id);
    run.films.push(film);
    this.#on.material(status.material);
  }

  async #follow(run) {
    try {
      for (;;) {
        const film = run.films.at(-1);
        if (film.done) this.#changed(run, film);
        else await this.#watch(run, film);
        if (run.over) return;
        if (run.stages.length === 0) break;
        await this.#post(run);
        if (run.over) return;
      }
      this.#traced.add(run.key);
      await this.#develop();
      if (!run.over) this.#on.progress(run.films.at(-1), true);
    } catch (error) {
      this.#fail(run, error);
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
          if (data.state === 'failed')
            failure = new Problem(data.error?.status ?? 500, data.error ?? {});
        }
        this.#changed(run, film);
      },
    });
    film.done = true;
    if (failure) throw failure;
  }

  #changed(run, film) {
    if (run.over) return;
    if (!film.glance) {
      this.#on.progress(film, false);
      if (film.samples > 0) this.#dropGlance(run);
    }
    if (film.samples > 0) this.#develop();
  }

  #dropGlance(run) {
    const [first] = run.films;
    if (!first.glance) return;
    run.films.shift();
    this.#service.remove(first.id);
  }

  /// Fetches the picture of the run from its best film; asked for meanwhile, once more after that.
  #develop() {
    this.#again = true;
    this.#developing ??= this.#developAll();
    return this.#developing;
  }

  async #developAll() {
    await null;  // #developing is set before it is cleared
    do {
      this.#again = false;
      const run = this.#run;
      if (!run || run.over) continue;
      const state = run.key === this.#key ? this.#state : run.state;
      const film = run.film(state);
      if (!film) continue;
      const {samples} = film;
      const content = JSON.stringify([film.id, samples, film.done && !film.glance, developQuery(state)]);
      if (content === run.shown) continue;
      try {
        const blob = await this.picture(film, state, film.glance ? 'jpeg' : 'png');  // quicker to make
        if (run.over) continue;
        this.#on.picture(blob, film, state, samples);
        run.shown = content;
        run.young = false;
        this.#next();
      } catch (error) {
        // Ended or removed between the two calls: the events tell what comes next.
        if (run.over || error.status === 409 || (film.glance && error.status === 404)) continue;
        if (error.status === 410) this.#traced.delete(run.key);  // removed to make room
        this.#fail(run, error);
      }
    } while (this.#again);
    this.#developing = null;
  }

  /// A film through the state's absorber.
  async picture(film, state, format) {
    const fields = new URLSearchParams({format, ...(film.glance ? displayQuery(state) : developQuery(state))});
    if (format === 'exr') {
      fields.delete('display');
      fields.delete('view');
    }
    if (!film.done) fields.set('partial', 'true');
    const response = await this.#service.call(`/v1/renders/${film.id}/image?${fields}`);
    return response.blob();
  }
}

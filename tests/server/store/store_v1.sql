-- A store of version 1, written by the last commit that had it (099f469^): a render that has
-- succeeded, one failed, one with a pass done and one held, one canceled, one queued.
BEGIN;
CREATE TABLE jobs(
  id TEXT PRIMARY KEY NOT NULL,
  state TEXT NOT NULL,
  request TEXT NOT NULL,
  material TEXT NOT NULL,
  idempotency_key TEXT UNIQUE,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  passes INTEGER NOT NULL DEFAULT 0,
  samples INTEGER NOT NULL DEFAULT 0,
  total_samples INTEGER,
  relative_error REAL,
  seconds REAL NOT NULL DEFAULT 0,
  eta_seconds REAL,
  stats TEXT,
  error TEXT,
  image TEXT);
INSERT INTO "jobs" VALUES('01KDVDNAZ8M8S4386A9CRDCD44','succeeded','{"image":{"height":8,"width":8},"material":{"absorber":"red-glass","anisotropy":0.0,"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"ior":1.5,"pigment":false,"reference_thickness_mm":10.0},"model":"transport","quality":{"samples":24},"scene":{"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],"up":[0.0,1.0,0.0],"vfov_deg":32.0},"environment":{"constant":[1.0,1.0,1.0],"rotation_deg":0.0,"scale":1.0},"object":{"radius_mm":20.0,"type":"sphere"}},"seed":1}','{}','key-of-1',1767225601000,1767225608000,1767225609000,1,24,24,0.05,0.2,NULL,'{"cpu_seconds":0.4,"nan_samples":0,"relative_error":0.05,"samples":24,"seconds":0.2,"threads":2,"traced_images":1,"transport":"walk","truncated_energy":0.0}',NULL,'image-0-1.exr');
INSERT INTO "jobs" VALUES('01KDVDNBYG4746X3GD750SXPNE','failed','{"image":{"height":8,"width":8},"material":{"absorber":"red-glass","anisotropy":0.0,"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"ior":1.5,"pigment":false,"reference_thickness_mm":10.0},"model":"transport","quality":{"samples":24},"scene":{"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],"up":[0.0,1.0,0.0],"vfov_deg":32.0},"environment":{"constant":[1.0,1.0,1.0],"rotation_deg":0.0,"scale":1.0},"object":{"radius_mm":20.0,"type":"sphere"}},"seed":2}','{}',NULL,1767225602000,1767225611000,1767225612000,0,0,24,NULL,0.0,NULL,NULL,'{"type":"/problems/internal","title":"t","status":500,"detail":"d"}',NULL);
INSERT INTO "jobs" VALUES('01KDVDNCXR7B4294NRVYWVBWQH','running','{"image":{"height":8,"width":8},"material":{"absorber":"red-glass","anisotropy":0.0,"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"ior":1.5,"pigment":false,"reference_thickness_mm":10.0},"model":"transport","quality":{"samples":24},"scene":{"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],"up":[0.0,1.0,0.0],"vfov_deg":32.0},"environment":{"constant":[1.0,1.0,1.0],"rotation_deg":0.0,"scale":1.0},"object":{"radius_mm":20.0,"type":"sphere"}},"seed":3}','{}',NULL,1767225603000,1767225614000,NULL,1,4,24,0.5,0.1,0.4,NULL,NULL,NULL);
INSERT INTO "jobs" VALUES('01KDVDNDX0FENRNE4DREK4CFPF','canceled','{"image":{"height":8,"width":8},"material":{"absorber":"red-glass","anisotropy":0.0,"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"ior":1.5,"pigment":false,"reference_thickness_mm":10.0},"model":"transport","quality":{"samples":24},"scene":{"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],"up":[0.0,1.0,0.0],"vfov_deg":32.0},"environment":{"constant":[1.0,1.0,1.0],"rotation_deg":0.0,"scale":1.0},"object":{"radius_mm":20.0,"type":"sphere"}},"seed":4}','{}',NULL,1767225604000,NULL,1767225606000,0,0,24,NULL,0.0,NULL,NULL,NULL,NULL);
INSERT INTO "jobs" VALUES('01KDVDNEW8NABJ6EB62CGSMDQ2','queued','{"image":{"height":8,"width":8},"material":{"absorber":"red-glass","anisotropy":0.0,"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"ior":1.5,"pigment":false,"reference_thickness_mm":10.0},"model":"transport","quality":{"samples":24},"scene":{"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],"up":[0.0,1.0,0.0],"vfov_deg":32.0},"environment":{"constant":[1.0,1.0,1.0],"rotation_deg":0.0,"scale":1.0},"object":{"radius_mm":20.0,"type":"sphere"}},"seed":5}','{}',NULL,1767225605000,NULL,NULL,0,0,24,NULL,0.0,NULL,NULL,NULL,NULL);
CREATE TABLE probe(id INTEGER PRIMARY KEY, written_ms INTEGER NOT NULL);
CREATE TABLE tasks(
  job_id TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE,
  pass_index INTEGER NOT NULL,
  first_sample INTEGER NOT NULL,
  sample_count INTEGER NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('ready', 'leased', 'done')),
  owner TEXT,
  lease_until_ms INTEGER NOT NULL DEFAULT 0,
  not_before_ms INTEGER NOT NULL DEFAULT 0,
  fencing_token INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  seconds REAL NOT NULL DEFAULT 0,
  PRIMARY KEY (job_id, pass_index)) WITHOUT ROWID;
INSERT INTO "tasks" VALUES('01KDVDNAZ8M8S4386A9CRDCD44',0,0,4,'done','47b685941a0a602b9b31c6c57312a53a',1767225637000,0,1,1,0.2);
INSERT INTO "tasks" VALUES('01KDVDNCXR7B4294NRVYWVBWQH',0,0,4,'done','47b685941a0a602b9b31c6c57312a53a',1767225643000,0,1,1,0.1);
INSERT INTO "tasks" VALUES('01KDVDNCXR7B4294NRVYWVBWQH',1,4,4,'leased','47b685941a0a602b9b31c6c57312a53a',1767225645000,0,1,1,0.0);
INSERT INTO "tasks" VALUES('01KDVDNEW8NABJ6EB62CGSMDQ2',0,0,4,'ready',NULL,0,0,0,0,0.0);
CREATE INDEX jobs_by_state ON jobs(state, id);
CREATE INDEX tasks_open ON tasks(job_id, pass_index) WHERE state <> 'done';
PRAGMA user_version = 1;
COMMIT;
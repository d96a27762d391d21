// What readers that nobody here wrote make of a Parquet file, as one JSON object:
//   node read.mjs FILE...   {"FILE": {"hyparquet": {rows, notes}, "duckdb": {rows, notes}}}
// Rows are objects by column; 64-bit numbers are numbers.
import { DuckDBInstance } from '@duckdb/node-api';
import { asyncBufferFromFile, parquetMetadataAsync, parquetReadObjects } from 'hyparquet';

const plain = (key, value) => (typeof value === 'bigint' ? Number(value) : value);

async function byHyparquet(file) {
  const buffer = await asyncBufferFromFile(file);
  const metadata = await parquetMetadataAsync(buffer);
  const notes = Object.fromEntries((metadata.key_value_metadata ?? []).map(({ key, value }) => [key, value]));
  return { rows: await parquetReadObjects({ file: buffer, metadata }), notes };
}

async function byDuckdb(connection, file) {
  const quoted = `'${file.replaceAll("'", "''")}'`;
  const rows = await connection.runAndReadAll(`select * from read_parquet(${quoted}, hive_partitioning = false)`);
  const notes = await connection.runAndReadAll(
    `select decode(key) as key, decode(value) as value from parquet_kv_metadata(${quoted})`);
  return {
    rows: rows.getRowObjectsJS(),
    notes: Object.fromEntries(notes.getRowObjectsJS().map(({ key, value }) => [key, value])),
  };
}

const instance = await DuckDBInstance.create();
const connection = await instance.connect();
const out = {};
for (const file of process.argv.slice(2))
  out[file] = { hyparquet: await byHyparquet(file), duckdb: await byDuckdb(connection, file) };
process.stdout.write(JSON.stringify(out, plain));

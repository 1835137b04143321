//! Files that are hashed while they are written or read, so that they need not be in memory.

use std::io::{self, Read, Write};

use sha2::{Digest, Sha256};

/// A writer that counts and hashes what is written.
#[derive(Debug)]
pub(crate) struct HashedWriter<W> {
    to: W,
    hash: Sha256,
    bytes: usize,
}

impl<W: Write> HashedWriter<W> {
    /// A writer that passes everything on to another one.
    pub fn new(to: W) -> HashedWriter<W> {
        HashedWriter {
            to,
            hash: Sha256::new(),
            bytes: 0,
        }
    }

    /// The other writer, the number of bytes, and their SHA-256 in hexadecimal.
    pub fn finish(self) -> (W, usize, String) {
        (self.to, self.bytes, hexadecimal(self.hash))
    }
}

impl<W: Write> Write for HashedWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.to.write(bytes)?;
        self.hash.update(&bytes[..written]);
        self.bytes += written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// SHA-256 of all that a reader has, in hexadecimal.
pub(crate) fn sha256_of(mut from: impl Read) -> io::Result<String> {
    let mut writer = HashedWriter::new(io::sink());
    io::copy(&mut from, &mut writer)?;
    Ok(writer.finish().2)
}

fn hexadecimal(hash: Sha256) -> String {
    hash.finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[cfg(test)]
mod tests {
    use formats::text::inputs::sha256;

    use super::*;

    #[test]
    fn what_is_written_in_pieces_has_the_hash_of_the_whole() {
        let mut writer = HashedWriter::new(Vec::new());
        for piece in ["run,", "", "/a,x.max\n", "1,0.5,2.5\n"] {
            writer.write_all(piece.as_bytes()).expect("memory");
        }
        let (bytes, count, hash) = writer.finish();
        assert_eq!((count, &hash), (bytes.len(), &sha256(&bytes)));
        assert_eq!(sha256_of(bytes.as_slice()).expect("memory"), hash);
    }
}
